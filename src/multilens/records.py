"""The nouns as plain data, records, lists, texts and numbers, as a file holds them, and back again.

A float is handed on as it is, so that what is read back is the same to the bit. Whatever reads checks every field; the name it
is given is the path of the key, and each refusal is a ValueError of one line that begins with it.
"""

from collections.abc import Sequence
from math import isfinite, nan
from typing import Any

import shapely
import torch
from shapely import LineString, MultiPolygon, Point, Polygon
from shapely.geometry.base import BaseGeometry

from multilens.back import Back, KeepOut
from multilens.certificate import Certificate, Clearance
from multilens.convergence import Convergence
from multilens.cues import CUES
from multilens.fields import choice, items, number, numbers, record, text, whole_number, within
from multilens.geometry.shape import Shape, checked_points
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem
from multilens.question import Question
from multilens.storage import Origin

Record = dict[str, Any]

SIGNIFICANT_DIGITS = 6
"""Of each score in the history of a search, which is there to be drawn."""

MOST_ERRORS = 10**7
"""Pairs and tiers times depths of a problem that is read: a small file must not ask for all the memory there is."""


def shape_record(shape: Shape) -> Record:
    """Give the core's type, its coordinates as GeoJSON nests them, and the radius."""
    core = shape.core
    if isinstance(core, MultiPolygon):
        coordinates = [_rings(part) for part in core.geoms]
    else:
        coordinates = _rings(core) if isinstance(core, Polygon) else _points(core)
    # GeoJSON has a point bare, not in a list.
    bare = coordinates[0] if isinstance(core, Point) else coordinates
    return {"core": core.geom_type, "radius": float(shape.radius), "coordinates": bare}


def read_shape(value: object, name: str) -> Shape:
    """Read what `shape_record` gives."""
    fields = record(value, name, ("core", "radius", "coordinates"))
    kind = choice(fields["core"], f"{name}.core", ("Polygon", "MultiPolygon", "LineString", "Point"))
    radius, place, coordinates = (
        number(fields["radius"], f"{name}.radius"),
        f"{name}.coordinates",
        fields["coordinates"],
    )
    if kind == "MultiPolygon":
        parts = [_read_polygon(part, f"{place}[{index}]") for index, part in enumerate(items(coordinates, place))]
        core: BaseGeometry = MultiPolygon(parts)
    elif kind == "Polygon":
        core = _read_polygon(coordinates, place)
    elif kind == "LineString":
        core = LineString(_read_points(coordinates, place, 2))
    else:
        core = Point(_read_points([coordinates], place, 1)[0])
    with within(name):
        return Shape(core, radius)


def back_record(back: Back) -> Record:
    """Give the outline and the keep-outs."""
    keep_outs = [
        {"name": keep_out.name, "clearance": float(keep_out.clearance), "shape": shape_record(keep_out.shape)}
        for keep_out in back.keep_outs
    ]
    return {"outline": shape_record(back.outline), "keep_outs": keep_outs}


def read_back(value: object, name: str) -> Back:
    """Read what `back_record` gives."""
    fields = record(value, name, ("outline", "keep_outs"))
    outline = read_shape(fields["outline"], f"{name}.outline")
    keep_outs = tuple(
        _read_keep_out(item, f"{name}.keep_outs[{index}]")
        for index, item in enumerate(items(fields["keep_outs"], f"{name}.keep_outs"))
    )
    with within(name):
        return Back(outline, keep_outs)


def lens_record(lens: Lens) -> Record:
    """Give everything that is known of a lens."""
    return {
        "focal_length": float(lens.focal_length),
        "aperture_radius": [float(bound) for bound in lens.aperture_radius],
        "focus": None if lens.focus is None else [float(bound) for bound in lens.focus],
        "clearance": float(lens.clearance),
        "disparity_noise": float(lens.disparity_noise),
        "blur_noise": float(lens.blur_noise),
        "tiers": int(lens.tiers),
        "position": None if lens.position is None else [None if x is None else float(x) for x in lens.position],
    }


def read_lens(value: object, name: str) -> Lens:
    """Read what `lens_record` gives."""
    keys = (
        "focal_length",
        "aperture_radius",
        "focus",
        "clearance",
        "disparity_noise",
        "blur_noise",
        "tiers",
        "position",
    )
    fields = record(value, name, keys)
    focus, position = fields["focus"], fields["position"]
    least, largest = numbers(fields["aperture_radius"], f"{name}.aperture_radius", 2)
    given: Record = {key: number(fields[key], f"{name}.{key}") for key in ("focal_length", *keys[3:6])}
    given["tiers"] = whole_number(fields["tiers"], f"{name}.tiers")
    given["focus"] = None if focus is None else tuple(numbers(focus, f"{name}.focus", 2))
    if position is not None:
        places = items(position, f"{name}.position", 2)
        x, y = (None if x is None else number(x, f"{name}.position[{axis}]") for axis, x in enumerate(places))
        given["position"] = (x, y)
    with within(name):
        return Lens(aperture_radius=(least, largest), **given)


def problem_record(problem: Question) -> Record:
    """Give a problem; its cues by their names in `multilens.cues.CUES`.

    Raises:
        TypeError: it is not a Problem, or one of its cues is not in the table: code is never written to a file.
    """
    if type(problem) is not Problem:
        raise TypeError(f"problem must be a Problem to be saved, got a {type(problem).__name__}, whose score is code")
    names = {cue: name for name, cue in CUES.items()}
    for cue in problem.cues:
        if type(cue) not in names:
            raise TypeError(
                f"cues must be among {', '.join(CUES)} to be saved, got a {type(cue).__name__}, which is code"
            )
    return {
        "back": back_record(problem.back),
        "lenses": [lens_record(lens) for lens in problem.lenses],
        "depths": problem.depths.tolist(),
        "weights": problem.weights.tolist(),
        "cues": [names[type(cue)] for cue in problem.cues],
        "gap": float(problem.gap),
    }


def read_problem(value: object, name: str) -> Problem:
    """Read what `problem_record` gives."""
    fields = record(value, name, ("back", "lenses", "depths", "weights", "cues", "gap"))
    back = read_back(fields["back"], f"{name}.back")
    lenses = [
        read_lens(item, f"{name}.lenses[{index}]")
        for index, item in enumerate(items(fields["lenses"], f"{name}.lenses"))
    ]
    depths = numbers(fields["depths"], f"{name}.depths")
    weights = numbers(fields["weights"], f"{name}.weights")
    cues = [
        CUES[choice(item, f"{name}.cues[{index}]", tuple(CUES))]()
        for index, item in enumerate(items(fields["cues"], f"{name}.cues"))
    ]
    gap = number(fields["gap"], f"{name}.gap")
    count = (len(lenses) ** 2 + sum(lens.tiers for lens in lenses)) * len(depths)
    if count > MOST_ERRORS:
        raise ValueError(f"{name} must have at most {MOST_ERRORS:g} pairs and tiers times depths, got {count:.2g}")
    with within(name):
        return Problem(back, lenses, depths, weights, cues, gap)


def layout_record(layout: Layout, lenses: Sequence[Lens]) -> list[Record]:
    """Give a row for each lens: position, aperture radius, and as many foci as the lens has tiers.

    Raises:
        ValueError: it is a batch, or of another number of lenses or of fewer tiers than these lenses have.
    """
    if layout.position.ndim != 2:
        raise ValueError(f"layout must be a single one, got a batch of the shape {list(layout.position.shape[:-2])}")
    if layout.count != len(lenses):
        raise ValueError(f"layout must have {len(lenses)} lenses, got {layout.count}")
    tiers = max(lens.tiers for lens in lenses)
    if layout.focus.shape[-1] < tiers:
        raise ValueError(f"focus must have a place for {tiers} tiers, got {layout.focus.shape[-1]}")
    rows = zip(layout.position.tolist(), layout.aperture_radius.tolist(), layout.focus.tolist(), lenses, strict=True)
    return [
        {"position": place, "aperture_radius": radius, "focus": foci[: lens.tiers]}
        for place, radius, foci, lens in rows
    ]


def read_layout(value: object, name: str, lenses: Sequence[Lens]) -> Layout:
    """Read what `layout_record` gives; a lens of fewer tiers than others repeats its first focus."""
    most = max(lens.tiers for lens in lenses)
    position, aperture_radius, focus = [], [], []
    for index, (item, lens) in enumerate(zip(items(value, name, len(lenses)), lenses, strict=True)):
        place = f"{name}[{index}]"
        fields = record(item, place, ("position", "aperture_radius", "focus"))
        foci = numbers(fields["focus"], f"{place}.focus", lens.tiers)
        position.append(numbers(fields["position"], f"{place}.position", 2))
        aperture_radius.append(number(fields["aperture_radius"], f"{place}.aperture_radius"))
        focus.append(foci + foci[:1] * (most - lens.tiers))
    return Layout(position, aperture_radius, focus)


def certificate_record(certificate: Certificate) -> list[Record]:
    """Give a record for each constraint."""
    return [
        {"what": clearance.what, "room": float(clearance.room), "kept": bool(clearance.kept)}
        for clearance in certificate.clearances
    ]


def read_certificate(value: object, name: str) -> Certificate:
    """Read what `certificate_record` gives."""
    clearances = []
    for index, item in enumerate(items(value, name)):
        place = f"{name}[{index}]"
        fields = record(item, place, ("what", "room", "kept"))
        if not isinstance(fields["kept"], bool):
            raise ValueError(f"{place}.kept must be true or false, got {fields['kept']!r:.40}")
        clearances.append(
            Clearance(text(fields["what"], f"{place}.what"), number(fields["room"], f"{place}.room"), fields["kept"])
        )
    return Certificate(tuple(clearances))


def convergence_record(convergence: Convergence) -> Record:
    """Give the history with 6 significant digits, a start in each row, and None for what is not finite."""
    return {
        "steps": list(convergence.steps),
        "polished": list(convergence.polished),
        "polished_scores": [score if isfinite(score) else None for score in convergence.polished_scores],
        "scores": [
            [float(f"{score:.{SIGNIFICANT_DIGITS}g}") if isfinite(score) else None for score in start]
            for start in convergence.scores.tolist()
        ],
    }


def read_convergence(value: object, name: str) -> Convergence:
    """Read what `convergence_record` gives, None as NaN."""
    fields = record(value, name, ("steps", "polished", "polished_scores", "scores"))
    steps, polished = (
        tuple(whole_number(item, f"{name}.{key}[{i}]") for i, item in enumerate(items(fields[key], f"{name}.{key}")))
        for key in ("steps", "polished")
    )
    starts = [
        _read_scores(start, f"{name}.scores[{index}]", len(steps))
        for index, start in enumerate(items(fields["scores"], f"{name}.scores"))
    ]
    for index in polished:
        if not 0 <= index < len(starts):
            raise ValueError(f"{name}.polished must name starts from 0 to {len(starts) - 1}, got {index}")
    polished_scores = tuple(_read_scores(fields["polished_scores"], f"{name}.polished_scores"))
    if len(polished_scores) > len(polished):
        raise ValueError(f"{name}.polished_scores must be at most {len(polished)}, got {len(polished_scores)}")
    scores = torch.tensor(starts, dtype=torch.float64).reshape(len(starts), len(steps))
    return Convergence(steps, scores, polished, polished_scores)


def origin_record(origin: Origin) -> Record:
    """Give what made a design."""
    return {
        "seed": int(origin.seed),
        "starts": int(origin.starts),
        "patience": int(origin.patience),
        "penalty": origin.penalty,
        "time_limit": None if origin.time_limit is None else float(origin.time_limit),
        "versions": dict(sorted(origin.versions.items())),
        "commit": origin.commit,
    }


def read_origin(value: object, name: str) -> Origin:
    """Read what `origin_record` gives."""
    fields = record(value, name, ("seed", "starts", "patience", "penalty", "time_limit", "versions", "commit"))
    seed, starts, patience = (whole_number(fields[key], f"{name}.{key}") for key in ("seed", "starts", "patience"))
    time_limit, versions, commit = fields["time_limit"], fields["versions"], fields["commit"]
    if not isinstance(versions, dict):
        raise ValueError(f"{name}.versions must be a record, got {versions!r:.40}")
    return Origin(
        seed,
        starts,
        patience,
        text(fields["penalty"], f"{name}.penalty"),
        None if time_limit is None else number(time_limit, f"{name}.time_limit"),
        {library: text(version, f"{name}.versions.{library:.40}") for library, version in versions.items()},
        None if commit is None else text(commit, f"{name}.commit"),
    )


def _points(geometry: BaseGeometry) -> list[list[float]]:
    return shapely.get_coordinates(geometry).tolist()


def _rings(polygon: Polygon) -> list[list[list[float]]]:
    return [_points(ring) for ring in (polygon.exterior, *polygon.interiors)]


def _read_points(value: object, name: str, least: int) -> list[tuple[float, float]]:
    pairs = [numbers(pair, f"{name}[{index}]", 2) for index, pair in enumerate(items(value, name))]
    if len(pairs) < least:
        raise ValueError(f"{name} must be at least {least} points, got {len(pairs)}")
    points = [(x, y) for x, y in pairs]
    with within(name):
        checked_points(points)
    return points


def _read_polygon(value: object, name: str) -> Polygon:
    rings = [_read_points(ring, f"{name}[{index}]", 3) for index, ring in enumerate(items(value, name))]
    if not rings:
        raise ValueError(f"{name} must be at least one ring, got none")
    return Polygon(rings[0], rings[1:])


def _read_scores(value: object, name: str, count: int | None = None) -> list[float]:
    return [
        nan if score is None else number(score, f"{name}[{index}]")
        for index, score in enumerate(items(value, name, count))
    ]


def _read_keep_out(value: object, name: str) -> KeepOut:
    fields = record(value, name, ("name", "clearance", "shape"))
    called, clearance = text(fields["name"], f"{name}.name"), number(fields["clearance"], f"{name}.clearance")
    shape = read_shape(fields["shape"], f"{name}.shape")
    with within(name):
        return KeepOut(called, shape, clearance)
