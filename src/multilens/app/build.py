"""From a configuration to the question it asks. Only `build_problem` and `build_question` need torch."""

import re
from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import replace
from math import isfinite
from typing import TYPE_CHECKING, Any

from omegaconf import DictConfig, OmegaConf, open_dict

from multilens.app.back_file import read_back_file
from multilens.app.cues import build_cues, check_cues
from multilens.app.estimates import refuse_stray_estimates
from multilens.app.photometry import build_scene, build_sensor, refuse_unknown_sensors
from multilens.app.refusal import RefusedError, one_line, refused_at
from multilens.app.robust import build_robust, check_robust
from multilens.app.schema import (
    BackConfig,
    Config,
    FieldOfViewConfig,
    LensConfig,
    LensesConfig,
    ShapeConfig,
    ShapeKind,
)
from multilens.app.schema_file import BackFileConfig
from multilens.app.score import build_depths, build_fusion, build_metric, check_score
from multilens.app.tolerance import build_tolerance
from multilens.back import Back
from multilens.field_of_view import Field
from multilens.geometry import shape
from multilens.geometry.shape import Shape
from multilens.lens import Lens
from multilens.ranges import LEAST, MOST

if TYPE_CHECKING:
    from multilens.problem import Problem
    from multilens.question import Question

MOST_LENSES = 64
MOST_KEEP_OUTS = 64
MOST_POINTS = 10_000
MOST_DEPTHS = 4096
MOST_STARTS = 65_536
MOST_BOXES = 10_000_000
MOST_RINGS = 1024
NAME = re.compile(r"[A-Za-z0-9._-]{1,100}")
KEEP_OUT_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9 ._-]{0,99}")

Pair = tuple[float, float]


def typed(config: DictConfig) -> Config:
    """Give a composed configuration as the schema's own dataclasses, whatever it was composed from.

    Raises:
        OmegaConfBaseException: a key is unknown, missing or of the wrong type.
    """
    job = config
    if "hydra" in job:
        job = deepcopy(job)
        with open_dict(job):
            job.pop("hydra")
    if OmegaConf.get_type(job) is not Config:
        job = OmegaConf.merge(OmegaConf.structured(Config), job)
    given = OmegaConf.to_object(job)
    assert isinstance(given, Config)
    return given


def check(config: Config) -> None:
    """Build everything that can be built without torch, and check the ranges of the rest.

    Raises:
        RefusedError: something is out of its range or does not go together.
    """
    if not NAME.fullmatch(config.name) or ".." in config.name or config.name == ".":
        raise RefusedError(f"name must be letters, digits, '.', '_' and '-' without '..', got {config.name!r}")
    build_back(config.back)
    build_lenses(config.lenses)
    refuse_stray_estimates(config)
    near, far = config.depth.near, config.depth.far
    if not (isfinite(near) and near > 0):
        raise RefusedError(f"depth.near must be > 0 mm and finite, got {near:g}")
    if not (isfinite(far) and far > near):
        raise RefusedError(f"depth.far must be > depth.near = {near:g} mm and finite, got {far:g}")
    for name, depth in (("near", near), ("far", far)):
        if not LEAST <= depth <= MOST:
            raise RefusedError(f"depth.{name} must be from {LEAST:g} to {MOST:g} mm, got {depth:g}")
    _refuse_unless_count("depth.count", config.depth.count, 2, MOST_DEPTHS)
    build_field(config.field_of_view)
    check_cues(config.cues)
    build_scene(config.scene)
    refuse_unknown_sensors(config.cues, config.lenses)
    check_score(config.metric, config.fusion, config.depth)
    check_robust(config.robust)
    build_tolerance(config.tolerance)
    _refuse_unless_count("search.starts", config.search.starts, 1, MOST_STARTS)
    _refuse_unless_count("search.patience", config.search.patience, 0, MOST_STARTS)
    _refuse_unless_count("search.proof", config.search.proof, 0, MOST_BOXES)
    _refuse_unless_count("search.seed", config.search.seed, 0, 2**31 - 1)
    limit = config.search.time_limit
    if limit is not None and not (isfinite(limit) and limit > 0):
        raise RefusedError(f"search.time_limit must be > 0 s and finite, or null for none, got {limit:g}")


def build_back(config: BackConfig) -> Back:
    """Make the back, its keep-outs in the order of the file and the configuration."""
    back = _build_outline(config)
    if len(config.keep_outs) > MOST_KEEP_OUTS:
        raise RefusedError(f"back.keep_outs must be at most {MOST_KEEP_OUTS}, got {len(config.keep_outs)}")
    for name, keep_out in config.keep_outs.items():
        if not KEEP_OUT_NAME.fullmatch(name):
            raise RefusedError(
                f"back.keep_outs: a name must be letters, digits, ' ', '.', '_' and '-', a letter or digit first, got {name!r}"
            )
        key = f"back.keep_outs.{name}"
        with refused_at(key):
            back = back.keep_out(name, _build_shape(f"{key}.shape", keep_out.shape), keep_out.clearance)
    return back


def _build_outline(config: BackConfig) -> Back:
    if config.file.path is not None:
        if config.outline is not None:
            raise RefusedError(
                "back must have an outline or a file, got both: begin with back=file, or set back.outline=null"
            )
        return read_back_file(config.file).back
    if config.outline is None:
        raise RefusedError("back must have an outline, or a file of one as in back.file.path=phone.dxf, got neither")
    for name, value in vars(config.file).items():
        if value != getattr(BackFileConfig, name):
            raise RefusedError(f"back.file.{name} is of a file: set back.file.path, too, or none of them")
    with refused_at("back.outline"):
        return Back(_build_shape("back.outline", config.outline))


def build_lenses(config: LensesConfig) -> tuple[Lens, ...]:
    """Make the lenses: `count` times `lens`, or `each`."""
    if not (isfinite(config.gap) and config.gap >= 0):
        raise RefusedError(f"lenses.gap must be >= 0 mm and finite, got {config.gap:g}")
    if config.each is not None:
        if config.count is not None or config.lens is not None:
            raise RefusedError(
                "lenses.each lists the lenses one by one: lenses.count and lenses.lens must be null beside it"
            )
        _refuse_unless_count("lenses.each: the number of lenses", len(config.each), 1, MOST_LENSES)
        lenses = tuple(_build_lens(f"lenses.each.{index}", lens) for index, lens in enumerate(config.each))
        return _placed(lenses, config.places)
    if config.lens is None or config.count is None:
        raise RefusedError("lenses must have count and lens, or each, got neither")
    _refuse_unless_count("lenses.count", config.count, 1, MOST_LENSES)
    return _placed((_build_lens("lenses.lens", config.lens),) * config.count, config.places)


def build_field(config: FieldOfViewConfig) -> Field | None:
    """Make the field in which depth is asked for; None for straight ahead alone."""
    _refuse_unless_count("field_of_view.rings", config.rings, 1, MOST_RINGS)
    if config.whole_deg is None:
        return None
    whole = config.whole_deg
    if not 0 < whole < 180:
        raise RefusedError(f"field_of_view.whole_deg must be > 0 and < 180 degrees, or null, got {whole:g}")
    return Field.rings(whole, config.rings)


def build_problem(config: Config) -> "Problem":
    """Make the question; this is where torch comes in.

    Raises:
        RefusedError: something is out of its range or does not go together.
    """
    from multilens.problem import Problem

    back, lenses = build_back(config.back), build_lenses(config.lenses)
    depths, weights = build_depths(config.depth)
    score = {"metric": build_metric(config.metric), "fusion": build_fusion(config.fusion), "guess": config.fusion.guess}
    with refused_at("cues"):
        field, cues = build_field(config.field_of_view), build_cues(config.cues, build_scene(config.scene))
        return Problem(back, lenses, depths, weights, cues, config.lenses.gap, field=field, **score)


def build_question(config: Config) -> "Question":
    """Make the problem, and ask it of many devices where something sets them apart from the one that is drawn.

    Raises:
        RefusedError: something is out of its range or does not go together.
    """
    return build_robust(config.robust, build_problem(config))


def _placed(lenses: tuple[Lens, ...], places: list[Any] | None) -> tuple[Lens, ...]:
    """Give the lenses with the places in place of their own; null leaves a lens as it is."""
    if places is None:
        return lenses
    if len(places) != len(lenses):
        raise RefusedError(f"lenses.places must be one for each of the {len(lenses)} lenses, got {len(places)}")
    pairs = enumerate(zip(lenses, places, strict=True))
    with refused_at("lenses.places"):
        return tuple(
            lens if place is None else replace(lens, position=_point(f"lenses.places.{index}", place))
            for index, (lens, place) in pairs
        )


def _build_lens(key: str, config: LensConfig) -> Lens:
    if config.focal_length is None:
        called = "" if config.name is None else f" ({config.name})"
        raise RefusedError(f"{key}.focal_length{called} is unknown, no source gives it: set it, mm, got null")
    others: dict[str, Any] = {
        "clearance": config.clearance,
        "disparity_noise": config.disparity_noise,
        "blur_noise": config.blur_noise,
        "tiers": config.tiers,
        "focus": None if config.focus is None else _pair(f"{key}.focus", config.focus),
        "position": None if config.position is None else _pair(f"{key}.position", config.position),
        "field_of_view_deg": config.field_of_view_deg,
        "near_focus": config.near_focus,
        "sensor": build_sensor(f"{key}.sensor", config.sensor),
        "name": config.name,
    }
    if (config.aperture_radius is None) == (config.f_number is None):
        given = "neither" if config.f_number is None else f"both; set the other to null, as in {key}.f_number=null"
        raise RefusedError(f"{key} must have either aperture_radius or f_number, got {given}")
    with refused_at(key):
        if config.f_number is not None:
            return Lens.from_f_number(config.focal_length, _pair(f"{key}.f_number", config.f_number), **others)
        return Lens(config.focal_length, _pair(f"{key}.aperture_radius", config.aperture_radius or []), **others)


def _rectangle(key: str, config: ShapeConfig) -> Shape:
    centre = None if config.centre is None else _pair(f"{key}.centre", config.centre)
    return shape.rectangle(config.width or 0, config.height or 0, centre, config.corner or 0)


def _disc(key: str, config: ShapeConfig) -> Shape:
    centre = (0.0, 0.0) if config.centre is None else _pair(f"{key}.centre", config.centre)
    return shape.disc(centre, config.radius or 0)


def _polygon(key: str, config: ShapeConfig) -> Shape:
    points = _ring(f"{key}.points", config.points)
    holes = [_ring(f"{key}.holes.{index}", hole) for index, hole in enumerate(config.holes or [])]
    return shape.polygon(points, holes)


def _ring(key: str, points: Any) -> list[Pair]:
    if not isinstance(points, list):
        raise RefusedError(f"{key} must be a list of points, [[x, y], ...], got {points!r}")
    if len(points) > MOST_POINTS:
        raise RefusedError(f"{key} must be at most {MOST_POINTS} points, got {len(points)}")
    return [_point(f"{key}.{index}", point) for index, point in enumerate(points)]


def _point(key: str, point: Any) -> Pair:
    if not isinstance(point, list) or not all(type(number) in (int, float) for number in point):
        raise RefusedError(one_line(f"{key} must be two numbers, got {point!r}"))
    try:
        return _pair(key, [float(number) for number in point])
    except OverflowError:
        raise RefusedError(f"{key} must be two numbers that a float can hold, got a larger one") from None


_SHAPES: dict[ShapeKind, tuple[Callable[[str, ShapeConfig], Shape], set[str], set[str]]] = {
    ShapeKind["rectangle"]: (_rectangle, {"width", "height"}, {"centre"}),
    ShapeKind["rounded_rectangle"]: (_rectangle, {"width", "height", "corner"}, {"centre"}),
    ShapeKind["disc"]: (_disc, {"radius"}, {"centre"}),
    ShapeKind["polygon"]: (_polygon, {"points"}, {"holes"}),
}
"""What makes each kind of shape, the fields that it needs and those that it may have."""


def _build_shape(key: str, config: ShapeConfig) -> Shape:
    make, needed, allowed = _SHAPES[config.kind]
    given = {name for name, value in vars(config).items() if value is not None} - {"kind"}
    for name in sorted(needed - given):
        raise RefusedError(f"{key}.{name} is missing: a {config.kind.name} needs {', '.join(sorted(needed))}")
    others = sorted(given - needed - allowed)
    if others:
        takes, nothing = ", ".join(sorted(needed | allowed)), " ".join(f"{key}.{name}=null" for name in others)
        raise RefusedError(f"{key}.{others[0]}: a {config.kind.name} takes {takes}, got {others[0]}; set {nothing}")
    with refused_at(key):
        return make(key, config)


def _pair(key: str, numbers: Sequence[float | None]) -> Any:
    if len(numbers) != 2:
        raise RefusedError(f"{key} must be two numbers, got {len(numbers)} of them")
    return tuple(numbers)


def _refuse_unless_count(key: str, count: int, least: int, most: int) -> None:
    if not least <= count <= most:
        raise RefusedError(f"{key} must be from {least} to {most}, got {count}")
