"""Branch and bound over the apertures: boxes of them are split, the weakest first, until the weakest is strong enough."""

from dataclasses import dataclass, field
from math import inf, pi

import numpy as np
from jaxtyping import Float, Int

from multilens.bounds.ascent import Focus, best_worth
from multilens.bounds.cut import Depths, savings, stereo_left
from multilens.bounds.kinds import Kind, bodies, ordered, pairs_of
from multilens.bounds.packing import Space
from multilens.bounds.tables import TabledCut

BATCH = 32
"""Boxes split at once."""

MOST_CUTS = 24
"""Each cut is tried on every box."""

WORTH_A_CUT = 0.01
"""Part by which a new cut must raise the box that it was made for, or the next one comes twice as many rounds later."""

ROOT_CUTS = 2
"""Cuts made before any box is split, each for the apertures that the last one thought best."""

ENOUGH = 1e-4
"""Part of the target that a bound may be below it and still be enough."""

SAFE = 1e-9
"""Part of all worth by which a bound is lowered: beyond what floats lose in the sums."""


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
            bound = np.maximum(bound, self._priced(cut, low, high, baseline, area).max(0) - SAFE * cut.worth.sum())
        return np.where(crowded, inf, bound)

    def _priced(
        self,
        cut: TabledCut,
        low: Int[np.ndarray, "m n"],
        high: Int[np.ndarray, "m n"],
        baseline: Float[np.ndarray, " m"],
        area: Float[np.ndarray, " m"],
    ) -> Float[np.ndarray, "p m"]:
        """Give the bound of a cut at each price of area, mm^2."""
        left = stereo_left(self.depths, cut.worth, baseline if self.stereo else 0 * baseline)
        priced = left - cut.prices[:, None] * area
        for kind, table in zip(self.kinds, cut.tables, strict=True):
            own = slice(*kind.columns)
            priced -= table.most(low[:, own], high[:, own]).sum(2)
        return priced

    def cut_for(self, low: Int[np.ndarray, " n"], high: Int[np.ndarray, " n"]) -> TabledCut:
        """Make the cut that is best where the cuts so far think a box is best."""
        baseline, _ = pairs_of(self.kinds, low[None], self.space.gap)
        node = self._best_node(low, high, baseline)
        alike: dict[tuple[float, tuple[float, float]], int] = {}
        for kind in self.kinds:
            for own in node[slice(*kind.columns)]:
                key = float(kind.effective_aperture[own]), kind.focus_range
                alike[key] = alike.get(key, 0) + kind.lens.tiers
        foci = tuple(Focus(aperture, focus_range, count) for (aperture, focus_range), count in alike.items())
        worth = best_worth(self.depths, foci, float(baseline[0]) if self.stereo else 0.0)
        saved = [
            kind.lens.tiers * savings(self.depths, worth, kind.effective_aperture, kind.focus_range)
            for kind in self.kinds
        ]
        areas = [pi * (kind.body + self.space.gap / 2) ** 2 for kind in self.kinds]
        return TabledCut.of(worth, saved, areas, [kind.count for kind in self.kinds], self.space.body_area)

    def _best_node(
        self, low: Int[np.ndarray, " n"], high: Int[np.ndarray, " n"], baseline: Float[np.ndarray, " 1"]
    ) -> Int[np.ndarray, " n"]:
        """Give the apertures of a box that its highest cut thinks best."""
        least, most = bodies(self.kinds, low[None]), bodies(self.kinds, high[None])
        area = self.space.coverable(least, most)
        node = high.copy()
        if not self.cuts:
            # Nothing is known: bodies that together fill the back, no wider than they may be.
            body = (area[0] / (pi * len(high))) ** 0.5
            for kind in self.kinds:
                own = slice(*kind.columns)
                node[own] = np.clip(np.searchsorted(kind.body, body), low[own], high[own])
            return node
        priced = [self._priced(cut, low[None], high[None], baseline, area)[:, 0] for cut in self.cuts]
        best = max(range(len(self.cuts)), key=lambda index: priced[index].max())
        price = int(priced[best].argmax())
        for kind, table in zip(self.kinds, self.cuts[best].tables, strict=True):
            for column in range(*kind.columns):
                values = table.node[price, low[column] : high[column] + 1]
                node[column] = low[column] + int(values.argmax())
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
            tree.cuts.append(tree.cut_for(low[0], high[0]))
    bound = tree.bounds(low, high, tree.cuts)
    root = float(bound[0])
    looked, rounds, next_cut, pause = 1, 0, 1, 1
    # Boxes that cannot be split any more and have had a cut of their own: one of them being the weakest is the end.
    settled = inf
    while looked < boxes and len(bound) and bound.min() < min(target * (1 - ENOUGH), settled):
        rounds += 1
        weakest = int(bound.argmin())
        whole = bool((high[weakest] - low[weakest] <= 1).all())
        if tree.defocus and len(tree.cuts) < MOST_CUTS and (whole or rounds >= next_cut):
            cut = tree.cut_for(low[weakest], high[weakest])
            tree.cuts.append(cut)
            before = float(bound[weakest])
            bound = np.maximum(bound, tree.bounds(low, high, [cut]))
            # Where a cut made for the weakest box hardly helped it, splitting does more than cuts for a while.
            pause = 1 if bound[weakest] > before * (1 + WORTH_A_CUT) else 2 * pause
            next_cut = rounds + pause
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
    child_low, child_high = ordered(tree.kinds, np.concatenate([low, upper_low]), np.concatenate([lower_high, high]))
    return child_low, child_high, np.concatenate([rows, rows])
