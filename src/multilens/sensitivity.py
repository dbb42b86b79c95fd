"""How much worse a finished design gets when one lens is not as it was drawn."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import pi

import torch
from jaxtyping import Float, Int
from torch import Tensor

from multilens.layout import Layout
from multilens.optics.drift import refocused
from multilens.problem import Problem
from multilens.robust import without

SHIFT, DECENTRE, APERTURE, FOCUS_DIOPTRE = 0.1, 0.001, 0.01, 0.01
"""By how much a lens is off: mm, mm over its sensor, part of its aperture, dioptres."""

DIRECTIONS = 72
"""In which a lens is shifted, every 5 degrees."""

SMALL = 1e-4
"""Part of a step that tells the slope on the side where it goes."""

KINK = 0.02
"""Part of a slope by which the gradient may miss it before the table says so."""

ROUNDING = 1e-10
"""Part of the figure below which a growth is none."""

FLAT = 1e-6
"""Part of the figure below which a slope, for the whole step, is none."""


@dataclass(frozen=True)
class Change:
    """By how much the figure grows, in its unit.

    Args:
        worst: by the whole step, in the worst direction; 0 where no direction is for the worse.
        slope: by the gradient alone, in its steepest direction.
        kink: whether the error has a corner here, so that the gradient does not tell where it goes: `worst` does.
    """

    worst: float
    slope: float
    kink: bool


@dataclass(frozen=True)
class LensSensitivity:
    """What it costs that one lens is off, in the unit of the figure.

    Args:
        shift: by 0.1 mm in its worst direction, which the calibration knows.
        unknown_shift: error of the depth if the calibration does not know of the same 0.1 mm; alone, not a growth.
        unknown_decentre: the same if the lens alone has moved over its sensor, by 0.001 mm.
        aperture: by 1 % of its aperture.
        focus: by 0.01 dioptre, all tiers alike.
        covered: growth of the figure without this lens; None where nothing would measure.
    """

    shift: Change
    unknown_shift: float
    unknown_decentre: float
    aperture: Change
    focus: Change
    covered: float | None


@dataclass(frozen=True)
class Sensitivity:
    """What it costs that lenses are off, lens by lens.

    Args:
        name: of the figure, such as RMSE.
        unit: of all numbers.
        figure: of the layout as it is drawn.
        lenses: a row for each.
    """

    name: str
    unit: str
    figure: float
    lenses: tuple[LensSensitivity, ...]

    def cells(self) -> list[list[str | int | float | None]]:
        """Give the table with its head, for programs."""
        head = [
            "lens",
            "shift_0.1_mm",
            "shift_slope",
            "unknown_shift_0.1_mm",
            "unknown_decentre_1_um",
            "aperture_1_percent",
            "aperture_slope",
            "focus_0.01_dioptre",
            "focus_slope",
            "covered",
        ]
        rows = [
            [i + 1, r.shift.worst, r.shift.slope, r.unknown_shift, r.unknown_decentre]
            + [number for change in (r.aperture, r.focus) for number in (change.worst, change.slope)]
            + [r.covered]
            for i, r in enumerate(self.lenses)
        ]
        return [[*head], *rows]

    def __str__(self) -> str:
        head = ("lens", "place 0.1 mm", "aperture 1 %", "focus 0.01 dpt", "covered", "unknown 0.1 mm", "unknown 1 um")
        rows = [
            (
                str(i + 1),
                *(_shown(change) for change in (row.shift, row.aperture, row.focus)),
                "all" if row.covered is None else f"{row.covered:+.3g}",
                f"{row.unknown_shift:.3g}",
                f"{row.unknown_decentre:.3g}",
            )
            for i, row in enumerate(self.lenses)
        ]
        width = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
        table = ["  ".join(map(str.rjust, row, width)).rstrip() for row in (head, *rows)]
        told = [
            f"if one lens is off: growth of the {self.name}, {self.figure:.6g} {self.unit}, in {self.unit};",
            f"unknown to the calibration: a camera aside by 0.1 mm, a lens over its sensor by 1 um, error made, in {self.unit}",
        ]
        kinks = any(change.kink for row in self.lenses for change in (row.shift, row.aperture, row.focus))
        note = ["* the error has a corner here: its gradient does not tell this"] if kinks else []
        return "\n".join([*told, *table, *note])


def sensitivity(problem: Problem, layout: Layout) -> Sensitivity:
    """Give what it costs that one lens of a layout is off; everything else stays as it is.

    Each step is taken and scored, in every direction; the gradient stands beside it. Where the two disagree the table says so: the
    error of the best measurement has corners where two are equally good, as they are in many a layout that was searched for.

    Args:
        problem: what the layout is to do.
        layout: one layout, not a batch.

    Returns:
        A table, in the unit in which the problem's metric is quoted.
    """
    layout = layout.to(torch.float64)
    figure = problem.metric.figure(problem.score(layout).item())
    slopes = _slopes(problem, layout, figure)
    winners = _winners(problem, layout)
    rows = tuple(_row(problem, layout, lens, slope, figure, winners) for lens, slope in enumerate(slopes))
    return Sensitivity(problem.metric.name, problem.metric.unit, figure, rows)


def _row(
    problem: Problem,
    layout: Layout,
    lens: int,
    slopes: tuple[float, float, float],
    figure: float,
    winners: Int[Tensor, " z"],
) -> LensSensitivity:
    shift, aperture, focus = (
        _change(problem, layout, lens, step, slope, figure)
        for step, slope in zip((_shifted, _opened, _refocused), slopes, strict=True)
    )
    focal_length = problem.lenses[lens].focal_length
    unknown = (
        _figure_of_bias(problem, layout, lens, SHIFT / problem.depths, winners),
        _figure_of_bias(problem, layout, lens, DECENTRE / focal_length + DECENTRE / problem.depths, winners),
    )
    return LensSensitivity(shift, *unknown, aperture, focus, _covered(problem, layout, lens, figure))


def _slopes(problem: Problem, layout: Layout, figure: float) -> Iterator[tuple[float, float, float]]:
    """Give for each lens by how much the figure would grow along its gradient with respect to place, aperture and focus."""
    parts = [part.detach().clone().requires_grad_() for part in (layout.position, layout.aperture_radius, layout.focus)]
    score = problem.terms(Layout(*parts)).amax()
    place, radius, focus = torch.autograd.grad(score, parts, allow_unused=True, materialize_grads=True)
    # A figure is the root of the score up to a fixed factor.
    by_score = figure / (2 * score.item()) if score > 0 else 0.0
    by_vergence = -focus * layout.focus**2
    for i in range(layout.count):
        yield (
            by_score * place[i].norm().item() * SHIFT,
            by_score * abs(radius[i].item()) * APERTURE * layout.aperture_radius[i].item(),
            by_score * abs(by_vergence[i, : problem.lenses[i].tiers].sum().item()) * FOCUS_DIOPTRE / 1000,
        )


def _change(
    problem: Problem,
    layout: Layout,
    lens: int,
    step: Callable[[Layout, int, float], Layout],
    slope: float,
    figure: float,
) -> Change:
    with torch.no_grad():
        scores = problem.score(_both(*(step(layout, lens, size) for size in (SMALL, 1.0)))).amax(-1)
    small, worst = (problem.metric.figure(score) - figure for score in scores.tolist())
    one_sided = small / SMALL
    return Change(
        worst if worst > ROUNDING * figure else 0.0,
        slope,
        abs(one_sided - slope) > KINK * slope + FLAT * figure / SMALL**0.5,
    )


def _shifted(layout: Layout, lens: int, size: float) -> Layout:
    angle = torch.arange(DIRECTIONS, dtype=torch.float64) * (2 * pi / DIRECTIONS)
    position = layout.position.expand(DIRECTIONS, -1, -1).clone()
    position[:, lens] += size * SHIFT * torch.stack([angle.cos(), angle.sin()], dim=-1)
    return _of_like(layout, position=position)


def _opened(layout: Layout, lens: int, size: float) -> Layout:
    radius = layout.aperture_radius.expand(2, -1).clone()
    radius[:, lens] *= 1 + size * APERTURE * torch.tensor([-1.0, 1.0], dtype=torch.float64)
    return _of_like(layout, aperture_radius=radius)


def _refocused(layout: Layout, lens: int, size: float) -> Layout:
    focus = layout.focus.expand(2, -1, -1).clone()
    off = size * FOCUS_DIOPTRE / 1000 * torch.tensor([[-1.0], [1.0]], dtype=torch.float64)
    focus[:, lens] = refocused(focus[:, lens], off)
    return _of_like(layout, focus=focus)


def _both(first: Layout, second: Layout) -> Layout:
    """Give two batches as one, [2, b]."""
    return Layout(*(torch.stack(parts) for parts in zip(vars(first).values(), vars(second).values(), strict=True)))


def _of_like(layout: Layout, **changed: Tensor) -> Layout:
    """Give a batch of layouts that differ in one part."""
    parts = vars(layout) | changed
    count = max(len(part) for part in changed.values())
    return Layout(*(part if name in changed else part.expand(count, *part.shape) for name, part in parts.items()))


def _winners(problem: Problem, layout: Layout) -> Int[Tensor, " z"]:
    """Give the index of the measurement that is best at each depth, -1 where all fail."""
    errors = problem.errors(layout)
    # Where every measurement fails none wins, and nothing that moves falsifies the guess.
    return errors.argmin(-2).where(errors.isfinite().any(-2), -1)


def _figure_of_bias(
    problem: Problem, layout: Layout, lens: int, direction: Float[Tensor, " z"], winners: Int[Tensor, " z"]
) -> float:
    """Give the figure of the depth errors of the pairs that win if one lens mistakes directions, rad, at its worst.

    Along the baseline b of a pair a mistake a of one lens makes an error of Z^2 a . b / abs(b)^2.
    """
    depths = problem.depths
    bias = torch.zeros(len(depths), 2, dtype=torch.float64)
    for k, measurement in enumerate(problem.measurements):
        if len(measurement.lenses) == 2 and lens in measurement.lenses:
            first, second = measurement.lenses
            apart = layout.position[first] - layout.position[second]
            made = (depths**2 * direction).unsqueeze(-1) * apart / apart.square().sum()
            bias = torch.where((winners == k).unsqueeze(-1), made, bias)
    if problem.metric.is_mean:
        # The largest of a quadratic form over all directions is its largest eigenvalue.
        worst = torch.linalg.eigvalsh(bias.T @ (problem.score_weights.unsqueeze(-1) * bias)).max()
    else:
        worst = (bias.square().sum(-1) * problem.metric.factor(depths))[problem.weights > 0].max()
    return problem.metric.figure(max(worst.item(), 0.0))


def _covered(problem: Problem, layout: Layout, lens: int, figure: float) -> float | None:
    others = [i for i in range(layout.count) if i != lens]
    try:
        left = without(problem, lens)
    except ValueError:
        return None
    with torch.no_grad():
        return left.metric.figure(left.score(layout.only(others)).item()) - figure


def _shown(change: Change) -> str:
    return f"{change.worst:+.3g}{'*' if change.kink else ' '}"
