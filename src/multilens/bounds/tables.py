"""A cut with all that depends on one lens tabled, so that thousands of boxes of apertures are bounded by looking up."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from jaxtyping import Float, Int

PRICE_STEPS = (0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8)
"""Prices of area that are tried, in parts of the best one when nothing is known of the apertures."""


@dataclass(frozen=True, eq=False)
class SavingsTable:
    """What a lens saves less what its area costs, at each node of its aperture, and the most over any stretch of nodes.

    Args:
        node: the value at each node, for each price of area, mm^2.
        stretch: no less than the largest value between nodes k and k + 2^level, mm^2.
    """

    node: Float[np.ndarray, "p a"]
    stretch: Float[np.ndarray, "p l a"]

    @classmethod
    def of(
        cls, saved: Float[np.ndarray, " a"], area: Float[np.ndarray, " a"], prices: Float[np.ndarray, " p"]
    ) -> "SavingsTable":
        """Make the table of a lens.

        Args:
            saved: no less than what all its foci save, mm^2.
            area: of its body, mm^2, growing with the node.
            prices: of area, mm^2 of score for 1 mm^2 of area, >= 0.
        """
        # Between two nodes: the larger saving of both for the smaller area.
        between = np.maximum(saved[1:], saved[:-1]) - prices[:, None] * area[:-1]
        none = np.full((len(prices), len(saved)), -inf)
        levels = [np.concatenate([between, none[:, :1]], axis=1)]
        step = 1
        while 2 * step < len(saved):
            later = np.concatenate([levels[-1][:, step:], none[:, :step]], axis=1)
            levels.append(np.maximum(levels[-1], later))
            step *= 2
        return cls(saved - prices[:, None] * area, np.stack(levels, axis=1))

    def most(self, low: Int[np.ndarray, "m n"], high: Int[np.ndarray, "m n"]) -> Float[np.ndarray, "p m n"]:
        """Give no less than the largest value between two nodes of each lens in each box, for each price, mm^2."""
        level = np.frexp(np.maximum(high - low, 1).astype(float))[1] - 1
        value = np.maximum(self.stretch[:, level, low], self.stretch[:, level, np.maximum(high - (1 << level), 0)])
        return np.where(high > low, value, self.node[:, low])


@dataclass(frozen=True, eq=False)
class TabledCut:
    """A cut.

    Args:
        worth: v of each depth, mm^2.
        saved: of each kind, no less than what all foci of one lens save at each node, mm^2.
        prices: of area, mm^2 of score for 1 mm^2 of area; the first is 0.
        tables: of each kind.
    """

    worth: Float[np.ndarray, " z"]
    saved: tuple[Float[np.ndarray, " _"], ...]
    prices: Float[np.ndarray, " p"]
    tables: tuple[SavingsTable, ...]

    @classmethod
    def of(
        cls,
        worth: Float[np.ndarray, " z"],
        saved: Sequence[Float[np.ndarray, " _"]],
        areas: Sequence[Float[np.ndarray, " _"]],
        counts: Sequence[int],
        room: float,
    ) -> "TabledCut":
        """Make the tables of a cut.

        Args:
            worth: v of each depth, mm^2.
            saved: of each kind, no less than what all foci of one lens save at each node, mm^2.
            areas: of one body of each kind at each node, mm^2.
            counts: lenses of each kind.
            room: area that all of them have, mm^2.
        """
        prices = np.append(0.0, best_price(saved, areas, counts, room) * np.array(PRICE_STEPS))
        prices = np.unique(prices)
        tables = tuple(SavingsTable.of(save, area, prices) for save, area in zip(saved, areas, strict=True))
        return cls(worth, tuple(saved), prices, tables)


def best_price(
    saved: Sequence[Float[np.ndarray, " _"]],
    areas: Sequence[Float[np.ndarray, " _"]],
    counts: Sequence[int],
    room: float,
) -> float:
    """Give the price of area at which what all lenses save, less what their areas cost, plus the price of all room is least.

    By weak duality each such sum is an upper bound on what lenses can save that share the room. The price is 0 where there is
    room enough.

    Args:
        saved: of each kind, what one lens saves at each node, mm^2.
        areas: of one body of each kind at each node, mm^2.
        counts: lenses of each kind.
        room: area that all of them have, mm^2.
    """
    highest = max(float((save / area).max()) for save, area in zip(saved, areas, strict=True))
    prices = np.append(0.0, highest * np.geomspace(1e-4, 1, 60))
    total = prices * room
    for save, area, count in zip(saved, areas, counts, strict=True):
        total = total + count * (save - prices[:, None] * area).max(1)
    return float(prices[total.argmin()])
