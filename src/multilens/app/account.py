"""What `multilens evaluate` says of a layout: its table, what was chosen for it, what it breaks, how well it measures where."""

from math import isfinite

from multilens.app.sweep import aligned
from multilens.bands import winner_bands
from multilens.design import Design
from multilens.problem import Problem
from multilens.robust import as_drawn
from multilens.search.evaluate import refocused, widened
from multilens.sensitivity import sensitivity

DEPTHS = 5
"""Depths told one by one, from the nearest to the farthest by equal steps of the problem's own."""

MOST_LINES = 12
"""Bands and broken constraints that are told; a terminal has some 40 lines."""


def account(design: Design, chosen: bool) -> str:
    """Say everything, in parts between blank lines.

    Args:
        design: of a Problem.
        chosen: whether apertures and foci were chosen by the evaluation, rather than stored with the layout.
    """
    parts = [str(design), _chosen(design) if chosen else "", _broken(design), _errors(design), _bands(design)]
    told = sensitivity(_problem(design), design.layout)
    return "\n\n".join(filter(None, [*parts, str(told)]))


def _chosen(design: Design) -> str:
    problem = _problem(design)
    every = set(range(len(problem.lenses)))
    wide, free = widened(problem), refocused(problem)
    lines = [
        f"apertures: {_split(every, wide, 'the widest of their range', 'fixed')}",
        f"foci: {_split(every, free, 'the best, found with all else fixed', 'fixed')}",
    ]
    return "\n".join(lines)


def _split(every: set[int], some: tuple[int, ...], found: str, otherwise: str) -> str:
    if not some:
        return f"{otherwise}, all"
    rest = tuple(sorted(every - set(some)))
    return f"{found}, {_lenses(some)}" + (f"; {otherwise}, {_lenses(rest)}" if rest else "")


def _lenses(indices: tuple[int, ...]) -> str:
    return ("lens " if len(indices) == 1 else "lenses ") + ", ".join(str(index + 1) for index in indices)


def _broken(design: Design) -> str:
    broken = [clearance for clearance in design.certificate.clearances if not clearance.kept]
    if not broken:
        return ""
    lines = [f"  {clearance.what} lacks {-clearance.room:.3g} mm" for clearance in broken]
    return "\n".join(["not feasible by the room that was asked for; scored all the same:", *_some(lines)])


def _errors(design: Design) -> str:
    problem = _problem(design)
    order = problem.depths.argsort()
    at = [order[round(step * (len(order) - 1) / (DEPTHS - 1))].item() for step in range(DEPTHS)]
    errors, winners = problem.errors(design.layout), problem.winners(design.layout)
    rows = [["depth (mm)", "error (mm)", "error (%)", "best measurement"]]
    for index in dict.fromkeys(int(one) for one in at):
        depth, winner = problem.depths[index].item(), int(winners[index])
        error = errors[winner, index].item()
        if isfinite(error):
            rows.append([f"{depth:.1f}", f"{error:.4g}", f"{100 * error / depth:.3g}", _label(problem, winner)])
        else:
            rows.append([f"{depth:.1f}", "-", "-", "none"])
    return aligned(rows)


def _bands(design: Design) -> str:
    bands = winner_bands(_problem(design), design.layout)
    rows = [[f"{band.near:.1f}", "to", f"{band.far:.1f} mm", band.measurement.label] for band in bands]
    return "\n".join(["best measurement by depth:", *_some([f"  {line}" for line in aligned(rows).splitlines()])])


def _label(problem: Problem, measurement: int) -> str:
    return problem.measurements[measurement].label


def _some(lines: list[str]) -> list[str]:
    more = len(lines) - MOST_LINES
    return lines if more <= 0 else [*lines[:MOST_LINES], f"  and {more} more"]


def _problem(design: Design) -> Problem:
    drawn = as_drawn(design.problem)
    assert isinstance(drawn, Problem)
    return drawn
