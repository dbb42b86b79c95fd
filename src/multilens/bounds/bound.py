"""A number that no feasible layout of a question scores below."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf

import numpy as np

from multilens.bounds.branch import Tree, branch
from multilens.bounds.cut import Depths
from multilens.bounds.kinds import kinds_of, pairs_of
from multilens.bounds.packing import Space
from multilens.bounds.room import body_area, box_area
from multilens.bounds.worst import Serving, least_worst
from multilens.cues import CUES, LensDefocus, PairStereo
from multilens.fusion import FUSIONS, Best
from multilens.problem import Problem
from multilens.question import Question
from multilens.robust import Robust

NOTHING_FITS = "no layout is feasible"


@dataclass(frozen=True)
class Bound:
    """What is known of the best score that any layout can have.

    Args:
        value: no feasible layout scores below it, in the unit of the score; None where none is known.
        reason: why none is known; empty where one is.
        root: the bound before the apertures were branched upon, in the same unit; None where none is known.
        boxes: of apertures that were looked at.
    """

    value: float | None
    reason: str = ""
    root: float | None = None
    boxes: int = 0

    @property
    def proves_that_nothing_fits(self) -> bool:
        """Whether there is no number because there is no feasible layout."""
        return self.reason.startswith(NOTHING_FITS)


def lower_bound(problem: Question, boxes: int = 4000, target: float = inf) -> Bound:
    """Give a number that no feasible layout of a question scores below: see docs/bounds.md for the proof.

    Known are bounds for the best of the cues PairStereo and LensDefocus, alone or together, where nothing is guessed. The same
    arguments give the same number: work is limited by a count, never by the clock.

    Args:
        problem: what is asked.
        boxes: of apertures to look at, >= 1; more bring the bound closer, 1 is the plain bound of a few hundredths of a second.
        target: a score that some layout has; the work ends when the bound is within a ten-thousandth of it.

    Raises:
        ValueError: boxes is out of its range.
    """
    if boxes < 1:
        raise ValueError(f"boxes must be >= 1, got {boxes}")
    if isinstance(problem, Robust):
        return Bound(None, "no bound is known for many devices")
    if not isinstance(problem, Problem):
        return Bound(None, "no bound is known for a score of one's own")
    strange = [cue for cue in problem.cues if type(cue) not in (PairStereo, LensDefocus)]
    if strange:
        return Bound(None, f"no bound is known for the cue {_name(strange[0], CUES)}")
    if not isinstance(problem.fusion, Best):
        return Bound(None, f"no bound is known for the fusion {_name(problem.fusion, FUSIONS)}")
    if problem.prior_error is not None:
        return Bound(None, "no bound is known where a guess stands in for what is not measured")
    kinds = kinds_of(problem)
    if kinds is None:
        return Bound(None, f"{NOTHING_FITS}: a lens has no room even at its smallest aperture")
    present = {type(cue) for cue in problem.cues}
    left, top, right, bottom = problem.back.outline.bounds
    space = Space(
        problem.gap,
        body_area(problem.back, problem.gap),
        box_area(problem.back, problem.gap),
        (right - left, bottom - top),
        _round(problem),
    )
    stereo = PairStereo in present and len(problem.lenses) > 1
    tree = Tree(_depths(problem), kinds, space, stereo, LensDefocus in present)
    if not problem.metric.is_mean:
        return _bound_of_worst(problem, tree)
    found = branch(tree, boxes, target)
    if found.value == inf:
        return Bound(None, f"{NOTHING_FITS}: the smallest apertures cannot be packed", boxes=found.boxes)
    return Bound(found.value, root=found.root, boxes=found.boxes)


def _bound_of_worst(problem: Problem, tree: Tree) -> Bound:
    """Give the bound of a score that is the largest of all depths."""
    smallest = np.zeros((1, len(problem.lenses)), dtype=int)
    if tree.bounds(smallest, smallest, [])[0] == inf:
        return Bound(None, f"{NOTHING_FITS}: the smallest apertures cannot be packed", boxes=1)
    baseline, _ = pairs_of(tree.kinds, smallest, problem.gap)
    ranges = np.array(problem.focus_range)
    serving = Serving(
        float(baseline[0]) if tree.stereo else 0.0,
        max(float(kind.effective_aperture[-1]) for kind in tree.kinds) if tree.defocus else 0.0,
        sum(lens.tiers for lens in problem.lenses),
        (float(ranges[:, 0].min()), float(ranges[:, 1].max())),
    )
    counted = problem.weights > 0
    factor = problem.metric.factor(problem.depths[counted]).numpy()
    value = least_worst(problem.depths[counted].numpy(), factor, serving)
    return Bound(value, root=value, boxes=1)


def _depths(problem: Problem) -> Depths:
    depth, weight = problem.depths.numpy(), problem.score_weights.numpy()
    order = np.argsort(depth, kind="stable")
    order = order[weight[order] > 0]
    return Depths(depth[order], weight[order])


def _round(problem: Problem) -> float | None:
    outline = problem.back.outline
    return outline.radius if outline.core.geom_type == "Point" else None


def _name(thing: object, table: Mapping[str, type]) -> str:
    """Give the word that a configuration has for it, or the name of a class of one's own."""
    return next((word for word, kind in table.items() if type(thing) is kind), type(thing).__name__)
