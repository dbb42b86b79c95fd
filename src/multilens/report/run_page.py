"""The page of one design."""

from dataclasses import asdict, dataclass
from math import inf
from typing import Any

import torch

from multilens.design import INFEASIBLE, Design
from multilens.metrics import as_quoted
from multilens.plot.bare import part_name
from multilens.plot.errors import curve_name
from multilens.plot.figures import title, warning
from multilens.plot.page import errors_svg, layout_svg
from multilens.plot.units import depth_unit, significant
from multilens.problem import Problem
from multilens.report.page import page
from multilens.report.stops import Stop, stops, what_counts
from multilens.report.table import NONE
from multilens.report.tables import (
    band_table,
    bound_in_words,
    clearance_table,
    lens_table,
    origin_table,
    proof_in_words,
    range_table,
    sensitivity_table,
)
from multilens.robust import as_drawn

LAYOUT, ERRORS = "layout", "errors"
"""Names of the two pictures on the page."""


@dataclass(frozen=True)
class Told:
    """One stop of the slider in words, and what lights up there.

    Args:
        millimetres: the depth itself.
        depth: with its unit.
        best: name of the best measurement.
        baseline: with its unit, or why there is none.
        blur: the same.
        error: the same.
        counted: error of all that counts there; empty where that is the same.
        lit: ids of the parts of both pictures that light up.
        lenses: numbers of the lenses that take part, from 1.
        right: of the mark on the curves from their lower left corner, points.
        down: the same downwards.
    """

    millimetres: float
    depth: str
    best: str
    baseline: str
    blur: str
    error: str
    counted: str
    lit: tuple[str, ...]
    lenses: tuple[int, ...]
    right: float
    down: float


def run_page(design: Design, config_text: str = "", log_text: str = "", estimates: str = "") -> str:
    """Give the page of a design as HTML; the same design and texts give the same bytes.

    Args:
        design: feasible, or as given.
        config_text: what was asked, as it was resolved.
        log_text: what the run said.
        estimates: which numbers no source gives, a line each.

    Raises:
        ValueError: the design is infeasible: there is nothing to tell.
    """
    if design.status == INFEASIBLE:
        raise ValueError(f"design must be feasible to be reported: {design.reason}")
    problem, layout = as_drawn(design.problem), design.layout
    told: dict[str, Any] = {"title": title(design.problem, layout), "warning": warning(problem, layout)}
    # The working range has a table of its own.
    told["facts"] = {name: words for name, words in design.facts().items() if name != "working range"}
    told |= {"lenses": lens_table(problem, layout), "bound": bound_in_words(design)}
    told |= {"proof": proof_in_words(design), "clearances": clearance_table(design)}
    told |= {"origin": None if design.origin is None else origin_table(design.origin)}
    told |= {"config": config_text, "log": log_text, "estimates": estimates}
    label = f"The back of the device to scale with {layout.count} lenses; the table of lenses has the numbers."
    told |= dict.fromkeys(("errors", "stops", "bands", "sensitivity", "range"))
    told["layout"] = layout_svg(problem, layout, LAYOUT, label)
    return page("run.html.j2", told | (_by_depth(design, problem) if isinstance(problem, Problem) else {}))


def _by_depth(design: Design, problem: Problem) -> dict[str, Any]:
    layout, found = design.layout, stops(problem, design.layout)
    label = "Depth error of every measurement against depth, and the best one; the table of who measures best has the numbers."
    depths, errors = [stop.depth for stop in found], [inf if stop.error is None else stop.error for stop in found]
    curves = errors_svg(problem, layout, ERRORS, label, design.tolerance, depths, errors)
    told = [_told(problem, stop, mark) for stop, mark in zip(found, curves.marks, strict=True)]
    return {
        "errors": curves.svg,
        "stops": {"left": curves.left, "across": curves.across, "stops": [asdict(stop) for stop in told]},
        "first": told[0],
        "counts": what_counts(problem),
        "bands": band_table(problem, layout),
        "sensitivity": sensitivity_table(design.sensitivity()),
        "range": None if design.tolerance is None else range_table(design.working_range(design.tolerance)),
    }


def _told(problem: Problem, stop: Stop, mark: tuple[float, float]) -> Told:
    unit, best = depth_unit(problem), stop.measurement
    blurs = [NONE if blur is None else f"{significant(blur)} mm" for blur in stop.blur]
    if len(blurs) == 2:
        blurs = [f"{blur} (lens {lens + 1})" for blur, lens in zip(blurs, best.lenses, strict=True)]
    lit: tuple[str, ...] = ()
    if best.lenses:
        parts = dict.fromkeys([part_name(best), *(f"lens-{lens + 1}" for lens in best.lenses)])
        lit = (*(f"{LAYOUT}-{part}" for part in parts), f"{ERRORS}-{curve_name(problem.measurements.index(best))}")
    return Told(
        stop.depth,
        f"{significant(stop.depth / unit.millimetres, 4)} {unit.name}",
        best.label if best.lenses else "nothing measures here",
        NONE if stop.baseline is None else f"{significant(stop.baseline, 4)} mm",
        ", ".join(blurs) or NONE,
        NONE if stop.error is None else _error(problem, stop.error, stop.depth),
        _error(problem, stop.counted, stop.depth) if what_counts(problem) else "",
        lit,
        tuple(lens + 1 for lens in best.lenses),
        *mark,
    )


def _error(problem: Problem, error: float, depth: float) -> str:
    """Say an error in mm, and where the metric has another unit in that too."""
    metric, mm = problem.metric, f"{significant(error)} mm"
    if metric.unit == "mm":
        return mm
    (quoted,) = as_quoted(metric, *(torch.tensor([number], dtype=torch.float64) for number in (error, depth))).tolist()
    return f"{mm}, {significant(quoted)} {metric.unit}"
