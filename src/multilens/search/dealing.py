"""The best foci of unlike apertures: which lens serves which depths, by dynamic programming over depths and lenses used."""

from dataclasses import dataclass
from itertools import product
from math import inf, prod

import numpy as np
from jaxtyping import Float, Int
from numpy.lib.stride_tricks import sliding_window_view

MOST_ENDS = 512
"""Places along the depths at which a stretch may begin or end; the time grows with the square."""

MOST_WORK = 1_500_000
"""Stretches that are compared; beyond, lenses of nearly equal slopes count as alike."""


@dataclass(frozen=True)
class Kind:
    """Lenses that are alike: whichever of them serves a stretch of depths does it equally well.

    Args:
        slope: of defocus, err = slope Z abs(Z - Zf), 1/mm.
        near: the least focus, mm.
        far: the largest, mm.
        members: which of the lenses.
    """

    slope: float
    near: float
    far: float
    members: tuple[int, ...]

    def joined(self, other: "Kind") -> "Kind":
        """Give both as one, of their mean aperture."""
        mine, its = len(self.members), len(other.members)
        slope = (mine + its) / (mine / self.slope + its / other.slope)
        return Kind(slope, min(self.near, other.near), max(self.far, other.far), self.members + other.members)


@dataclass(frozen=True)
class _Table:
    """For every end and length of a stretch, the focus that serves it best and what it costs."""

    focus: Float[np.ndarray, "e l"]
    cost: Float[np.ndarray, "e l"]


@dataclass(frozen=True)
class _Way:
    """The least cost of the depths before every end with some of the lenses, and the last stretch of one of them."""

    least: Float[np.ndarray, " e"]
    ended: Int[np.ndarray, " e"]
    kind: Int[np.ndarray, " e"]
    length: Int[np.ndarray, " e"]


class Dealing:
    """Depths dealt out to foci in stretches, with stereo between them.

    At each depth the least error counts, so whatever each depth is given to costs no less than the score. Where every lens is
    the best of all over one stretch the two are equal, and the least of these costs is the least score. A lens beats stereo
    over a stretch that is short where it is steep, which bounds what has to be looked at.

    Args:
        depths: mm, in any order.
        weights: how much each counts.
    """

    def __init__(self, depths: Float[np.ndarray, " z"], weights: Float[np.ndarray, " z"]) -> None:
        order = depths.argsort(kind="stable")
        depth, weight = depths[order], weights[order]
        ends = np.unique(np.linspace(0, len(depth), min(len(depth), MOST_ENDS) + 1).round().astype(int))
        self.moments = [np.concatenate([[0.0], (weight * depth**power).cumsum()])[ends] for power in (2, 3, 4)]
        self.beside = depth[ends.clip(max=len(depth) - 1)]
        """The depth after each end, mm; after the last, the last."""

    def best_foci(
        self,
        gain: float,
        slope: Float[np.ndarray, " f"],
        near: Float[np.ndarray, " f"],
        far: Float[np.ndarray, " f"],
    ) -> Float[np.ndarray, " f"]:
        """Give the foci that serve the depths best.

        Args:
            gain: of stereo, err = gain Z^2, 1/mm; infinite where there is none.
            slope: of defocus of each focus, err = slope Z abs(Z - Zf), 1/mm.
            near: the least that each focus may be, mm.
            far: the largest, mm.

        Returns:
            mm. A focus that serves no depth is anywhere within its bounds.
        """
        gain = self._as_dear_as_any(gain, slope, near)
        kinds = self._few_kinds(gain, _alike(slope, near, far))
        foci = np.empty(len(slope))
        for focus, kind, turn in self._stretches(gain, kinds):
            foci[kinds[kind].members[turn]] = focus
        return foci.clip(near, far)

    def best_in_order(
        self,
        gain: float,
        slope: Float[np.ndarray, " f"],
        near: Float[np.ndarray, " f"],
        far: Float[np.ndarray, " f"],
        order: Int[np.ndarray, " f"],
    ) -> Float[np.ndarray, " f"]:
        """Give the foci that serve the depths best where it is known which of them comes after which; none counts as another.

        Args:
            gain: this and the next three as for `best_foci`.
            slope: of each focus.
            near: of each.
            far: of each.
            order: of the foci, the nearest first.

        Returns:
            mm, of each focus.
        """
        gain = self._as_dear_as_any(gain, slope, near)
        kinds = [Kind(float(slope[at]), float(near[at]), float(far[at]), (int(at),)) for at in order]
        by_stereo = gain**2 * self.moments[2]
        foci, least, steps = np.empty(len(slope)), by_stereo, []
        for kind in kinds:
            table = self._table(kind, self._longest(gain, kind.slope))
            way = _cheapest(by_stereo, {0: (least, table)})
            steps.append((kind, table, way))
            least = way.least
        end = len(self.beside) - 1
        for kind, table, way in reversed(steps):
            end = way.ended[end]
            foci[kind.members[0]] = table.focus[end, way.length[end]]
            end -= way.length[end]
        return foci.clip(near, far)

    def _as_dear_as_any(self, gain: float, slope: np.ndarray, near: np.ndarray) -> float:
        """Give the gain of stereo, where there is none one that is dearer than any lens at any depth, and no more.

        Of what is dearer still sums would lose their digits.
        """
        farthest = max(self.beside[-1], near.max())
        return min(gain, 2 * float(slope.max() * farthest / self.beside[0]))

    def _few_kinds(self, gain: float, kinds: list[Kind]) -> list[Kind]:
        longest = self._longest(gain, kinds[0].slope)
        while len(kinds) > 1 and _transitions(kinds) * len(self.beside) * longest > MOST_WORK:
            at = min(range(len(kinds) - 1), key=lambda i: kinds[i + 1].slope / kinds[i].slope)
            kinds = [*kinds[:at], kinds[at].joined(kinds[at + 1]), *kinds[at + 2 :]]
        return kinds

    def _longest(self, gain: float, slope: float) -> int:
        """Give the most ends that a lens passes on the depths where it can beat stereo, whatever its focus."""
        ratio = (slope + gain) / (slope - gain) if slope > gain else inf
        last = self.beside.searchsorted(self.beside * ratio, side="right").clip(max=len(self.beside) - 1)
        return max(1, int((last - np.arange(len(last))).max()))

    def _stretches(self, gain: float, kinds: list[Kind]) -> list[tuple[float, int, int]]:
        """Give the focus, the kind and a turn within it for every lens."""
        tables = [self._table(kind, self._longest(gain, kind.slope)) for kind in kinds]
        by_stereo = gain**2 * self.moments[2]
        none = tuple(0 for _ in kinds)
        ways, least = {}, {none: by_stereo}
        for used in product(*(range(len(kind.members) + 1) for kind in kinds)):
            if used != none:
                ways[used] = _cheapest(by_stereo, {k: (least[_one_less(used, k)], tables[k]) for k in _kinds_of(used)})
                least[used] = ways[used].least
        used, end = tuple(len(kind.members) for kind in kinds), len(self.beside) - 1
        dealt = []
        while used != none:
            way = ways[used]
            end = way.ended[end]
            kind, length = int(way.kind[end]), int(way.length[end])
            dealt.append((float(tables[kind].focus[end, length]), kind, used[kind] - 1))
            used, end = _one_less(used, kind), end - length
        return dealt

    def _table(self, kind: Kind, longest: int) -> _Table:
        end = np.arange(len(self.beside))[:, None]
        begin = end - np.arange(longest + 1)
        second, third, fourth = (moment[end] - moment[begin.clip(min=0)] for moment in self.moments)
        focus = np.clip(third / np.where(second > 0, second, 1), kind.near, kind.far)
        cost = kind.slope**2 * (fourth - 2 * focus * third + focus**2 * second).clip(min=0)
        cost[begin < 0] = inf
        # A focus that is left over serves an empty stretch.
        cost[:, 0], focus[:, 0] = 0, self.beside
        return _Table(focus, cost)


def _alike(slope: np.ndarray, near: np.ndarray, far: np.ndarray) -> list[Kind]:
    """Give lenses by their kinds, the least slope first."""
    rows, of_row = np.unique(np.column_stack([slope, near, far]), axis=0, return_inverse=True)
    members = [tuple(np.flatnonzero(of_row.ravel() == row).tolist()) for row in range(len(rows))]
    columns = rows.T.tolist()
    return [Kind(h, low, high, each) for h, low, high, each in zip(*columns, members, strict=True)]


def _transitions(kinds: list[Kind]) -> int:
    """Give how often a lens is added to others."""
    states = prod(len(kind.members) + 1 for kind in kinds)
    return sum(states * len(kind.members) // (len(kind.members) + 1) for kind in kinds)


def _kinds_of(used: tuple[int, ...]) -> list[int]:
    return [kind for kind, count in enumerate(used) if count]


def _one_less(used: tuple[int, ...], kind: int) -> tuple[int, ...]:
    return (*used[:kind], used[kind] - 1, *used[kind + 1 :])


def _cheapest(by_stereo: Float[np.ndarray, " e"], ways: dict[int, tuple[np.ndarray, _Table]]) -> _Way:
    """Give the cheapest ways that end in a stretch of one kind, after which stereo may serve until a later end."""
    ends = np.arange(len(by_stereo))
    ended, kind_of, length_of = np.full(len(ends), inf), np.zeros_like(ends), np.zeros_like(ends)
    for kind, (before, table) in ways.items():
        window = table.cost.shape[1]
        begun = sliding_window_view(np.concatenate([np.full(window - 1, inf), before]), window)[:, ::-1]
        total = begun + table.cost
        length = total.argmin(1)
        cost = total[ends, length]
        less = cost < ended
        ended = np.where(less, cost, ended)
        kind_of, length_of = np.where(less, kind, kind_of), np.where(less, length, length_of)
    beyond = ended - by_stereo
    least = np.minimum.accumulate(beyond)
    at = np.maximum.accumulate(np.where(beyond == least, ends, 0))
    return _Way(least + by_stereo, at, kind_of, length_of)
