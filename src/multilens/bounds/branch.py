"""Branch and bound over the apertures: boxes of them are split, the weakest first, until the weakest is strong enough."""

from dataclasses import dataclass, field
from math import inf, pi

import numpy as np
from jaxtyping import Bool, Float, Int

from multilens.bounds.ascent import Focus, best_worth
from multilens.bounds.cut import Depths, savings, stereo_left
from multilens.bounds.kinds import Kind, bodies, ordered, pairs_of
from multilens.bounds.packing import Space

BATCH = 64
"""Boxes split at once."""

MOST_CUTS = 12
"""Each cut is tried on every box."""

ROOT_CUTS = 3
"""Cuts made before any box is split, each for the apertures that the last one thought best."""

ENOUGH = 1e-4
"""Part of the target that a bound may be below it and still be enough."""

AREA_PRICES = (0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8)
"""Prices of area that are tried, in parts of the one that is best before any box is split."""

SAFE = 1e-9
"""Part of all worth by which a bound is lowered: beyond what floats lose in the sums."""


@dataclass(frozen=True, eq=False)
class Row:
    """What lenses of one kind are worth at each node, less a price for their area, and the largest of any stretch of nodes.

    Args:
        node: the value at each node.
        stretch: by powers of two, the largest value between nodes k and k + 2^level.
    """

    node: Float[np.ndarray, " a"]
    stretch: Float[np.ndarray, "l a"]

    @classmethod
    def of(cls, saved: Float[np.ndarray, " a"], area: Float[np.ndarray, " a"], price: float) -> "Row":
        """Table what an aperture saves, mm^2, less the price of the area it takes; both grow with the aperture."""
        # Between two nodes: the savings of the upper one for the area of the lower one.
        levels = [np.append(np.maximum(saved[1:], saved[:-1]) - price * area[:-1], -inf)]
        step = 1
        while step < len(saved) - 1:
            last = levels[-1]
            levels.append(np.maximum(last, np.append(last[step:], np.full(min(step, len(last)), -inf))))
            step *= 2
        return cls(saved - price * area, np.stack(levels))

    def largest(self, low: Int[np.ndarray, "*m"], high: Int[np.ndarray, "*m"]) -> Float[np.ndarray, "*m"]:
        """Give the largest value between two nodes."""
        length = np.maximum(high - low, 1)
        level = np.frexp(length.astype(float))[1] - 1
        value = np.maximum(self.stretch[level, low], self.stretch[level, np.maximum(high - (1 << level), 0)])
        return np.where(high > low, value, self.node[low])


@dataclass(frozen=True, eq=False)
class TabledCut:
    """A cut with all that depends on one lens tabled.

    Args:
        worth: v of each depth, mm^2.
        saved: of each kind, what all foci of one lens save at most at each node, mm^2.
        prices: of area, 0 among them.
        rows: of each price and kind.
    """

    worth: Float[np.ndarray, " z"]
    saved: tuple[Float[np.ndarray, " a"], ...]
    prices: tuple[float, ...]
    rows: tuple[tuple[Row, ...], ...]


@dataclass(frozen=True, eq=False)
class Tree:
    """What does not change while boxes are split.

    Args:
        depths: where the score is taken.
        kinds: of the lenses.
        space: that they share.
        stereo: whether pairs measure.
        defocus: whether lenses measure.
    """

    depths: Depths
    kinds: tuple[Kind, ...]
    space: Space
    stereo: bool
    defocus: bool
    cuts: list[TabledCut] = field(default_factory=list)

    def bounds(
        self, low: Int[np.ndarray, "m n"], high: Int[np.ndarray, "m n"], cuts: list[TabledCut]
    ) -> Float[np.ndarray, " m"]:
        """Give a bound for each box of nodes, in order: infinite where nothing fits, 0 at least."""
        least, most = bodies(self.kinds, low), bodies(self.kinds, high)
        baseline, crowded = pairs_of(self.kinds, low, self.space.gap)
        crowded |= (low > high).any(1) | self.space.crowded(least, most)
        if not self.defocus:
            bound = self.depths.stereo.sum() / baseline**2 * (1 - SAFE)
            return np.where(crowded, inf, bound)
        bound = np.zeros(len(low))
        area = self.space.coverable(least, most)
        for cut in cuts:
            left = stereo_left(self.depths, cut.worth, baseline if self.stereo else 0 * baseline)
            for price, rows in zip(cut.prices, cut.rows, strict=True):
                saved = self._saved(rows, low, high) + price * area
                bound = np.maximum(bound, left - saved - SAFE * cut.worth.sum())
        return np.where(crowded, inf, bound)

    def _saved(
        self, rows: tuple[Row, ...], low: Int[np.ndarray, "m n"], high: Int[np.ndarray, "m n"]
    ) -> Float[np.ndarray, " m"]:
        total = np.zeros(len(low))
        for kind, row in zip(self.kinds, rows, strict=True):
            own = slice(*kind.columns)
            total += row.largest(low[:, own], high[:, own]).sum(1)
        return total

    def areas(self) -> tuple[Float[np.ndarray, " a"], ...]:
        """Give the area of a body grown by half the gap at each node of each kind, mm^2."""
        return tuple(pi * (kind.body + self.space.gap / 2) ** 2 for kind in self.kinds)

    def cut_for(self, node: Int[np.ndarray, " n"], baseline: float) -> TabledCut:
        """Make the cut that is best for one aperture of each lens and one baseline."""
        alike: dict[tuple[float, tuple[float, float]], int] = {}
        for kind in self.kinds:
            for own in node[slice(*kind.columns)]:
                key = float(kind.effective_aperture[own]), kind.focus_range
                alike[key] = alike.get(key, 0) + kind.lens.tiers
        foci = tuple(Focus(aperture, focus_range, count) for (aperture, focus_range), count in alike.items())
        worth = best_worth(self.depths, foci, baseline if self.stereo else 0.0)
        saved = tuple(
            kind.lens.tiers * savings(self.depths, worth, kind.effective_aperture, kind.focus_range)
            for kind in self.kinds
        )
        areas = self.areas()
        best = self._best_price(saved, areas)
        prices = (0.0, *(best * part for part in AREA_PRICES)) if best > 0 else (0.0,)
        rows = tuple(
            tuple(Row.of(save, area, price) for save, area in zip(saved, areas, strict=True)) for price in prices
        )
        return TabledCut(worth, saved, prices, rows)

    def _best_price(
        self, saved: tuple[Float[np.ndarray, " a"], ...], areas: tuple[Float[np.ndarray, " a"], ...]
    ) -> float:
        """Give the price of area at which all lenses together save least beyond what the area costs; 0 where there is enough."""
        smallest = min(float(area[0]) for area in areas)
        highest = max(float(save.max()) for save in saved) / smallest
        if highest <= 0:
            return 0.0
        prices = np.append(0.0, highest * np.geomspace(1e-4, 1, 60))
        total = np.full(len(prices), 0.0) + prices * self.space.body_area
        for kind, save, area in zip(self.kinds, saved, areas, strict=True):
            total += kind.count * (save - prices[:, None] * area).max(1)
        return float(prices[total.argmin()])

    def weakest_node(self, low: Int[np.ndarray, " n"], high: Int[np.ndarray, " n"]) -> Int[np.ndarray, " n"]:
        """Give the apertures of a box that its best cut thinks best."""
        if not self.cuts:
            return high
        least, most = bodies(self.kinds, low[None]), bodies(self.kinds, high[None])
        area = self.space.coverable(least, most)
        baseline, _ = pairs_of(self.kinds, low[None], self.space.gap)
        tried = []
        for cut in self.cuts:
            left = stereo_left(self.depths, cut.worth, baseline if self.stereo else 0 * baseline)
            for price, rows in zip(cut.prices, cut.rows, strict=True):
                value = left - self._saved(rows, low[None], high[None]) - price * area
                tried.append((float(value[0]), len(tried), rows))
        rows = max(tried)[2]
        node = low.copy()
        for kind, row in zip(self.kinds, rows, strict=True):
            for column in range(*kind.columns):
                node[column] += int(row.node[low[column] : high[column] + 1].argmax())
        return node


@dataclass(frozen=True)
class Branched:
    """What splitting came to.

    Args:
        value: that no box scores below, mm^2; infinite where nothing fits.
        root: the same before any box was split, mm^2.
        boxes: how many were looked at.
    """

    value: float
    root: float
    boxes: int


def branch(tree: Tree, boxes: int, target: float) -> Branched:
    """Split boxes of apertures until so many were looked at, or none scores below the target.

    Args:
        tree: what is asked.
        boxes: how many to look at, >= 1.
        target: a bound of so much is enough, mm^2.
    """
    sizes = [len(kind.aperture) for kind in tree.kinds for _ in range(kind.count)]
    low, high = np.zeros((1, len(sizes)), dtype=int), np.array([sizes]) - 1
    if tree.defocus:
        for _ in range(ROOT_CUTS):
            node = tree.weakest_node(low[0], high[0])
            baseline, _ = pairs_of(tree.kinds, low, tree.space.gap)
            tree.cuts.append(tree.cut_for(node, float(baseline[0])))
    bound = tree.bounds(low, high, tree.cuts)
    root = float(bound[0])
    looked, rounds = 1, 0
    # Boxes that cannot be split any more and have had a cut of their own: one of them being the weakest is the end.
    settled = inf
    while looked < boxes and len(bound) and bound.min() < min(target * (1 - ENOUGH), settled):
        rounds += 1
        weakest = int(bound.argmin())
        whole = bool((high[weakest] - low[weakest] <= 1).all())
        if tree.defocus and len(tree.cuts) < MOST_CUTS and (whole or rounds & (rounds - 1) == 0):
            baseline, _ = pairs_of(tree.kinds, low[weakest : weakest + 1], tree.space.gap)
            cut = tree.cut_for(tree.weakest_node(low[weakest], high[weakest]), float(baseline[0]))
            tree.cuts.append(cut)
            bound = np.maximum(bound, tree.bounds(low, high, [cut]))
        order = np.argsort(bound, kind="stable")
        chosen, kept = order[:BATCH], order[BATCH:]
        ended = (high[chosen] - low[chosen] <= 1).all(1)
        settled = min(settled, float(bound[chosen[ended]].min(initial=inf)))
        chosen = chosen[~ended]
        child_low, child_high, parent = _split(tree, low[chosen], high[chosen])
        found = np.maximum(bound[chosen][parent], tree.bounds(child_low, child_high, tree.cuts))
        looked += len(found)
        open_ = found < target
        low = np.concatenate([low[kept], child_low[open_]])
        high = np.concatenate([high[kept], child_high[open_]])
        bound = np.concatenate([bound[kept], found[open_]])
    value = min(float(bound.min(initial=inf)), settled)
    return Branched(value if value < target else target, root, looked)


def _split(
    tree: Tree, low: Int[np.ndarray, "m n"], high: Int[np.ndarray, "m n"]
) -> tuple[Int[np.ndarray, "k n"], Int[np.ndarray, "k n"], Int[np.ndarray, " k"]]:
    """Halve each box where its two ends save most unlike, and give the halves and whose they are."""
    effect = bodies(tree.kinds, high) - bodies(tree.kinds, low)
    if tree.cuts:
        for kind, saved in zip(tree.kinds, tree.cuts[-1].saved, strict=True):
            own = slice(*kind.columns)
            effect[:, own] = saved[high[:, own]] - saved[low[:, own]] + 1e-12 * effect[:, own]
    effect = np.where(high - low > 1, effect, -inf)
    column = effect.argmax(1)
    rows = np.arange(len(low))
    middle = (low[rows, column] + high[rows, column]) // 2
    lower_high, upper_low = high.copy(), low.copy()
    lower_high[rows, column] = middle
    upper_low[rows, column] = middle
    child_low, child_high = ordered(
        tree.kinds, np.concatenate([low, upper_low]), np.concatenate([lower_high, high])
    )
    return child_low, child_high, np.concatenate([rows, rows])
