"""What is told of a design, as tables of words."""

from collections.abc import Sequence
from math import isfinite

from multilens.bands import NOTHING, Band, errors_at, winner_bands
from multilens.constraints import body_radius
from multilens.design import TOUCHING, Design
from multilens.layout import Layout
from multilens.lens import telling_names
from multilens.plot.units import depth_unit, significant
from multilens.problem import Problem
from multilens.question import Question
from multilens.report.stops import baseline_of
from multilens.report.table import NONE, Table
from multilens.sensitivity import Change, Sensitivity
from multilens.storage import Origin
from multilens.working_range import WorkingRange

PLACED = ("x (mm)", "y (mm)", "aperture radius (mm)", "f-number", "focal length (mm)", "body radius (mm)")


def lens_table(problem: Question, layout: Layout, name: str = "lenses") -> Table:
    """Tell where each lens stands, how wide it opens and where it focuses."""
    names = telling_names(problem.lenses)
    head = ("lens", *("name" for _ in names[:1]), *PLACED)
    bodies = body_radius(layout, problem.lenses).tolist()
    rows = []
    for i, (lens, (x, y), radius) in enumerate(
        zip(problem.lenses, layout.position.tolist(), layout.aperture_radius.tolist(), strict=True)
    ):
        numbers = (
            f"{radius:.3f}",
            f"{lens.focal_length / (2 * radius):.2f}",
            f"{lens.focal_length:g}",
            f"{bodies[i]:.3f}",
        )
        row = (str(i + 1), *names[i : i + 1], f"{x:.3f}", f"{y:.3f}", *numbers)
        foci = layout.focus[i, : lens.tiers].tolist()
        rows.append((*row, ", ".join(f"{focus:.1f}" for focus in foci)) if isinstance(problem, Problem) else row)
    if isinstance(problem, Problem):
        head = (*head, "focus (mm)")
    caption = "Each lens. x runs to the right and y down, seen from behind; the body is the aperture and its clearance."
    return Table(name, caption, head, tuple(rows), words=(1,) if names else ())


def band_table(problem: Problem, layout: Layout) -> Table:
    """Tell who measures best over which depths."""
    unit, bands = depth_unit(problem), winner_bands(problem, layout)
    head = (f"from ({unit.name})", f"to ({unit.name})", "best", "baseline (mm)", "error at both ends (mm)")
    rows = tuple(
        (
            significant(band.near / unit.millimetres, 4),
            significant(band.far / unit.millimetres, 4),
            band.measurement.label,
            NONE if (baseline := baseline_of(layout, band.measurement)) is None else significant(baseline, 4),
            _errors_at_ends(problem, layout, band),
        )
        for band in bands
    )
    return Table("bands", "The best measurement from the nearest depth to the farthest.", head, rows, words=(2,))


def clearance_table(design: Design) -> Table:
    """Tell every constraint with its room, the tightest first."""
    order = sorted(design.certificate.clearances, key=lambda clearance: (clearance.kept, clearance.room))
    rows = tuple(
        (each.what, f"{0.0 if 0 <= each.room < TOUCHING else each.room:.4g}", "kept" if each.kept else "broken")
        for each in order
    )
    caption = "Every constraint, the tightest first. Room is what is left beyond what is required."
    return Table("clearances", caption, ("constraint", "room (mm)", "exactly"), rows, words=(2,))


def proof_in_words(design: Design) -> str:
    """Say what the certificate proves."""
    every = design.certificate.clearances
    broken = sum(not clearance.kept for clearance in every)
    kept = f"All {len(every)} are kept, at tolerance 0." if not broken else f"{broken} of {len(every)} are broken."
    return (
        "Each constraint was checked in exact rational arithmetic on the decimals that are stored, by code that the search "
        f"does not share: no square root, no rounding, no tolerance. {kept}"
    )


def bound_in_words(design: Design) -> str:
    """Say how far from the best possible the design may be."""
    bound = design.bound
    if bound is None:
        return "No lower bound was sought."
    if bound.value is None:
        return f"No lower bound: {bound.reason}."
    told = design.facts()["lower bound"]
    return (
        f"{told[0].upper()}{told[1:]}. The bound holds for every layout that fits, whoever finds it, "
        "and was computed in floating-point numbers."
    )


def sensitivity_table(found: Sensitivity) -> Table:
    """Tell what it costs that one lens is off."""
    head = (
        "lens",
        "place off by 0.1 mm",
        "aperture off by 1 %",
        "focus off by 0.01 dioptre",
        "covered",
        "camera moved by 0.1 mm, unknown",
        "lens moved by 0.001 mm over its sensor, unknown",
    )
    rows = tuple(
        (
            str(i + 1),
            *(_changed(change) for change in (row.shift, row.aperture, row.focus)),
            "nothing measures" if row.covered is None else f"{row.covered:+.3g}",
            f"{row.unknown_shift:.3g}",
            f"{row.unknown_decentre:.3g}",
        )
        for i, row in enumerate(found.lenses)
    )
    caption = (
        f"If one lens is off: by how much the {found.name}, {significant(found.figure, 4)} {found.unit}, grows, in {found.unit}, "
        f"in the worst direction. The last two columns are errors made, in {found.unit}, where the calibration does not know. "
        "A star marks a corner of the error, which the gradient does not tell."
    )
    return Table("sensitivity", caption, head, rows)


def range_table(found: WorkingRange) -> Table:
    """Tell the depths within a tolerance."""
    rows = tuple((f"{near:.5g}", f"{far:.5g}") for near, far in found.intervals)
    looked = f"of the depths from {found.near:.5g} to {found.far:.5g} mm"
    caption = f"Where the error is at most {found.tolerance}: {100 * found.share:.3g} % {looked}."
    return Table("range", caption, ("from (mm)", "to (mm)"), rows or ((NONE, NONE),))


def origin_table(origin: Origin) -> Table:
    """Tell what made a design."""
    limit = NONE if origin.time_limit is None else f"{origin.time_limit:g} s"
    rows = [
        ("seed", str(origin.seed)),
        ("starts", str(origin.starts)),
        ("patience", str(origin.patience)),
        ("penalty", origin.penalty),
        ("time limit", limit),
        ("layouts known before", str(origin.known)),
        ("commit", origin.commit or NONE),
        *(sorted(origin.versions.items())),
    ]
    return Table("origin", "What made this design.", ("what", "value"), tuple(rows), words=(1,))


def _errors_at_ends(problem: Problem, layout: Layout, band: Band) -> str:
    if band.measurement == NOTHING:
        return NONE
    depths = problem.depths.new_tensor([band.near, band.far])
    ends: Sequence[float] = errors_at(problem, layout, depths)[problem.measurements.index(band.measurement)].tolist()
    return " and ".join(significant(error) if isfinite(error) else NONE for error in ends)


def _changed(change: Change) -> str:
    return f"{change.worst:+.3g}{'*' if change.kink else ''}"
