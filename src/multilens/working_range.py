"""Where a layout measures depth well enough: the depths at which its error is within a tolerance."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor

from multilens.bands import dense_depths, errors_at
from multilens.depths import log_depths
from multilens.field_of_view import Part
from multilens.fusion import Best
from multilens.layout import Layout
from multilens.problem import Problem
from multilens.tolerance import Tolerance

LOOKS = 4096
"""Depths that are looked at where others than a problem's own are asked for."""

HALVINGS = 60
"""Of an interval that holds an end: more than the bits of a double."""

THIRDS = 100
"""Steps, each taking a third off an interval that holds a turning point: as many bits."""

Excess = Callable[[Tensor], Tensor]
"""From depths, mm, to the error over what is allowed, [c, depths]: a depth is within tolerance where one of c is 1 or less."""


@dataclass(frozen=True)
class WorkingRange:
    """The depths whose error is within a tolerance.

    Args:
        tolerance: that is kept.
        near: nearest depth that was looked at, mm.
        far: farthest depth that was looked at, mm.
        intervals: near and far end of each stretch of depths within tolerance, mm, from near to far.
    """

    tolerance: Tolerance
    near: float
    far: float
    intervals: tuple[tuple[float, float], ...]

    @property
    def whole(self) -> bool:
        """Whether every depth that was looked at is within tolerance."""
        return self.intervals == ((self.near, self.far),)

    @property
    def share(self) -> float:
        """Part of the depths that is within tolerance, by length, 0 to 1."""
        if self.far == self.near:
            return float(bool(self.intervals))
        return sum(far - near for near, far in self.intervals) / (self.far - self.near)

    def __str__(self) -> str:
        looked = f"{self.near:.5g} to {self.far:.5g} mm"
        if not self.intervals:
            return f"nowhere from {looked} is the error at most {self.tolerance}"
        stretches = [f"{near:.5g} to {far:.5g} mm" if far > near else f"{far:.5g} mm" for near, far in self.intervals]
        part = f"all of {looked}" if self.whole else f"{', '.join(stretches)} ({self.share:.3g} of {looked})"
        return f"{part}, error at most {self.tolerance}"


def working_range(
    problem: Problem, layout: Layout, tolerance: Tolerance, span: tuple[float, float] | None = None
) -> WorkingRange:
    """Give the depths at which a layout's error is within a tolerance, in every part of the field that is asked for.

    Where the best measurement counts, each is followed by itself, else all together. An end is where the error meets what is
    allowed: it is found by halving, to the last bits. Turning points of the error between the depths that are looked at are
    found too; only one that turns twice between two of them may hide a stretch. The depths looked at are the problem's own,
    seven between each two, and the in-focus depths. A guess of what is not measured counts for nothing here.

    Args:
        problem: whose cues measure, with its lenses.
        layout: one layout, not a batch.
        tolerance: largest error.
        span: nearest and farthest depth to look at, mm, where it is not the problem's own range; then 4,096 depths, each the
            same factor beyond the last, and the in-focus depths.

    Returns:
        The stretches of depths, at each end of which the tolerance is kept.

    Raises:
        ValueError: the span is out of its range.
    """
    depths = dense_depths(problem, layout) if span is None else _spanned(layout, span)
    near, far = depths[0].item(), depths[-1].item()
    found = ((near, far),)
    for part in problem.parts:
        excess = _excess(problem, layout, part, tolerance)
        looked = torch.cat([depths, _turning_points(excess, depths)]).unique()
        found = _common(found, _united(_stretches(excess, looked)))
    return WorkingRange(tolerance, near, far, found)


def allowed_error(tolerance: Tolerance, depths: Float[Tensor, " m"]) -> Float[Tensor, " m"]:
    """Give the largest error that a tolerance allows at each depth, mm."""
    share = inf if tolerance.percent is None else tolerance.percent / 100
    return (depths * share).clamp(max=inf if tolerance.mm is None else tolerance.mm)


def _excess(problem: Problem, layout: Layout, part: Part, tolerance: Tolerance) -> Excess:
    """Give the errors of what the lenses of one part of the field measure, over what is allowed."""
    seen = [k for k, measurement in enumerate(problem.measurements) if set(measurement.lenses) <= set(part.lenses)]
    own, lenses = layout.to(torch.float64).only(part.lenses), [problem.lenses[index] for index in part.lenses]

    def errors(depths: Float[Tensor, " m"]) -> Float[Tensor, "c m"]:
        if not seen:
            return torch.full_like(depths, inf).unsqueeze(0)
        if isinstance(problem.fusion, Best):
            return errors_at(problem, layout, depths)[seen]
        with torch.no_grad():
            return problem.fusion.squared_error(problem.cues, own, lenses, depths).sqrt().unsqueeze(0)

    return lambda depths: errors(depths) / allowed_error(tolerance, depths)


def _spanned(layout: Layout, span: tuple[float, float]) -> Float[Tensor, " m"]:
    near, far = span
    foci = layout.focus.detach().double().flatten()
    return torch.cat([log_depths(near, far, LOOKS), foci[(foci > near) & (foci < far)]]).unique()


def _turning_points(excess: Excess, depths: Float[Tensor, " m"]) -> Float[Tensor, " t"]:
    """Give where an error beyond tolerance is least, and one within it largest, between two depths."""
    value = excess(depths)
    before, here, after = value[:, :-2], value[:, 1:-1], value[:, 2:]
    # Where the error is beyond tolerance its valleys count, where it is within its peaks: the other way round they change nothing.
    turn = torch.where(here > 1, (here <= before) & (here <= after), (here >= before) & (here >= after))
    row, column = (turn & here.isfinite()).nonzero().unbind(-1)
    if not len(row):
        return depths[:0]
    sign = torch.where(here[row, column] > 1, 1.0, -1.0)
    low, high = depths[column], depths[column + 2]
    for _ in range(THIRDS):
        third = (high - low) / 3
        left, right = _at(excess, row, low + third), _at(excess, row, high - third)
        nearer = sign * left <= sign * right
        low, high = torch.where(nearer, low, low + third), torch.where(nearer, high - third, high)
    return low


def _stretches(excess: Excess, depths: Float[Tensor, " m"]) -> list[tuple[float, float]]:
    """Give the stretches within tolerance of every measurement, from their ends at the last depth that keeps it."""
    inside = excess(depths) <= 1
    begin, end = _edges(inside, before=True), _edges(inside, before=False)
    near = _ends(excess, begin[0], depths[(begin[1] - 1).clamp(min=0)], depths[begin[1]])
    far = _ends(excess, end[0], depths[(end[1] + 1).clamp(max=len(depths) - 1)], depths[end[1]])
    return list(zip(near.tolist(), far.tolist(), strict=True))


def _edges(inside: Bool[Tensor, "c m"], before: bool) -> tuple[Int[Tensor, " e"], Int[Tensor, " e"]]:
    """Give row and column of the first of every run of depths within tolerance, or of the last: in the same order."""
    outside = torch.zeros_like(inside[:, :1])
    next_to = torch.cat([outside, inside[:, :-1]] if before else [inside[:, 1:], outside], dim=1)
    row, column = (inside & ~next_to).nonzero().unbind(-1)
    return row, column


def _ends(
    excess: Excess, row: Int[Tensor, " e"], beyond: Float[Tensor, " e"], within: Float[Tensor, " e"]
) -> Float[Tensor, " e"]:
    """Give the depth nearest to `beyond` at which the tolerance is kept, between it and `within`."""
    if not len(row):
        return within
    for _ in range(HALVINGS):
        middle = (beyond + within) / 2
        kept = _at(excess, row, middle) <= 1
        beyond, within = torch.where(kept, beyond, middle), torch.where(kept, middle, within)
    return within


def _at(excess: Excess, row: Int[Tensor, " e"], depths: Float[Tensor, " e"]) -> Float[Tensor, " e"]:
    return excess(depths)[row, torch.arange(len(row))]


def _united(stretches: list[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Give stretches in ascending order, those that touch as one."""
    united: list[tuple[float, float]] = []
    for near, far in sorted(stretches):
        if united and near <= united[-1][1]:
            united[-1] = (united[-1][0], max(far, united[-1][1]))
        else:
            united.append((near, far))
    return tuple(united)


def _common(
    first: tuple[tuple[float, float], ...], second: tuple[tuple[float, float], ...]
) -> tuple[tuple[float, float], ...]:
    """Give what lies in stretches of both."""
    both = ((max(a[0], b[0]), min(a[1], b[1])) for a in first for b in second)
    return tuple(sorted((near, far) for near, far in both if near <= far))
