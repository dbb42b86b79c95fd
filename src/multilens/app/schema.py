"""What a configuration may hold: plain dataclasses, so that an unknown key or a wrong type is refused.

Nothing here names a class or a function: kinds and cues are words from a fixed list, which `build` looks up in tables.
"""

from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from hydra.core.config_store import ConfigStore
from omegaconf import MISSING

from multilens.app.schema_cues import CuesConfig, SceneConfig, SensorConfig
from multilens.app.schema_file import BackFileConfig
from multilens.app.schema_score import FusionConfig, HistogramConfig, MetricConfig

SCHEMA = "multilens_schema"
"""Name under which `conf/config.yaml` asks for the schema."""

ShapeKind = Enum("ShapeKind", ["rectangle", "rounded_rectangle", "disc", "polygon"])
"""The kinds of outline that a configuration can name."""

PenaltyName = Enum("PenaltyName", ["distance", "area"])
"""The penalties that a configuration can name."""

Spacing = Enum("Spacing", ["linear", "log"])
"""How depths are spread between near and far."""


@dataclass
class ShapeConfig:
    """An outline, mm; each kind takes only fields of its own.

    Args:
        kind: rectangle (width, height, centre), rounded_rectangle (and corner), disc (centre, radius) or polygon (points, holes).
        width: along x.
        height: along y.
        centre: x and y; a rectangle without one has its top left at the origin, a disc its centre.
        corner: radius of the corners.
        radius: of the disc.
        points: corners of the polygon, in order.
        holes: of the polygon, each a list of corners.
    """

    kind: ShapeKind = MISSING
    width: float | None = None
    height: float | None = None
    centre: list[float] | None = None
    corner: float | None = None
    radius: float | None = None
    # Of lists within lists OmegaConf refuses whole numbers where it expects floats: `build` checks them instead.
    points: list[Any] | None = None
    holes: list[Any] | None = None


@dataclass
class KeepOutConfig:
    """A place that lenses stay clear of.

    Args:
        shape: its outline.
        clearance: distance that a body keeps from it, mm.
    """

    shape: ShapeConfig = field(default_factory=ShapeConfig)
    clearance: float = 0.0


@dataclass
class BackConfig:
    """Where lenses may stand.

    Args:
        outline: of the back; null where a file has it.
        keep_outs: by name, beside those of the file.
        file: a drawing that the back is read from.
        estimates: which of these numbers no source gives, by their keys below the back, and what each rests on.
    """

    outline: ShapeConfig | None = None
    keep_outs: dict[str, KeepOutConfig] = field(default_factory=dict)
    file: BackFileConfig = field(default_factory=BackFileConfig)
    estimates: dict[str, str] = field(default_factory=dict)


@dataclass
class LensConfig:
    """One kind of lens; what each field means is told by `multilens.lens.Lens`.

    Args:
        focal_length: mm; null where it is unknown, which is refused when the lens is needed.
        aperture_radius: least and largest, mm; or f_number instead.
        f_number: least and largest; or aperture_radius instead.
        focus: nearest and farthest in-focus depth, mm; null for the range of the depths.
        clearance: from the rim of the aperture to the rim of the body, mm.
        disparity_noise: mm on the sensor.
        blur_noise: mm on the sensor.
        tiers: sensors behind the one aperture.
        position: x and y, mm, null for a free lens, null in place of one of them for a lens that slides.
        field_of_view_deg: angle of the whole cone that the lens sees; null where unknown.
        near_focus: nearest depth that the lens brings into focus, mm; null where unknown.
        sensor: what stands behind it; null where unknown.
        name: what the lens is called, such as tele.
        estimates: which of these numbers no source gives, by their keys, and what each rests on.
    """

    focal_length: float | None = MISSING
    aperture_radius: list[float] | None = None
    f_number: list[float] | None = None
    focus: list[float] | None = None
    clearance: float = 0.0
    disparity_noise: float = 1.0
    blur_noise: float = 1.0
    tiers: int = 1
    position: list[float | None] | None = None
    field_of_view_deg: float | None = None
    near_focus: float | None = None
    sensor: SensorConfig | None = None
    name: str | None = None
    estimates: dict[str, str] = field(default_factory=dict)


@dataclass
class LensesConfig:
    """Several equal lenses (count, lens), or each by itself (each).

    Args:
        count: how many equal ones.
        lens: what each of them is.
        each: the lenses one by one; then count and lens are null.
        gap: distance that bodies keep from each other, mm.
        places: x and y of every lens, mm, in place of their positions; null leaves these as they are.
        estimates: which of these numbers no source gives, by their keys below the lenses, and what each rests on.
    """

    count: int | None = None
    lens: LensConfig | None = None
    each: list[LensConfig] | None = None
    gap: float = 0.0
    # Of lists within lists OmegaConf refuses whole numbers where it expects floats: `build` checks them instead.
    places: list[Any] | None = None
    estimates: dict[str, str] = field(default_factory=dict)


@dataclass
class DepthConfig:
    """Where depth is to be measured.

    Args:
        near: mm.
        far: mm.
        count: how many depths from near to far.
        spacing: linear or log.
        histogram: how much the depths of each bin count; without bins all count alike.
    """

    near: float = MISSING
    far: float = MISSING
    count: int = 512
    spacing: Spacing = Spacing["log"]
    histogram: HistogramConfig = field(default_factory=HistogramConfig)


@dataclass
class FieldOfViewConfig:
    """How far from straight ahead depth is to be measured.

    Args:
        whole_deg: the field from side to side; null asks straight ahead alone.
        rings: of equal area that the field is divided into.
    """

    whole_deg: float | None = None
    rings: int = 8


@dataclass
class DriftConfig:
    """What moves after the calibration, each number a standard deviation; `multilens.cues.drift.Drift` tells more.

    Args:
        shift: of a camera, lens and sensor together, mm.
        decentre_um: of a lens over its own sensor, um.
        focus_dioptre: of one over the in-focus depth, dioptres.
    """

    shift: float = 0.0
    decentre_um: float = 0.0
    focus_dioptre: float = 0.0


@dataclass
class RobustConfig:
    """What sets devices apart from the one that is drawn; nothing, for a design of that one.

    Args:
        shift: of each lens as it is built, along x and along y, mm, standard deviation.
        focus_dioptre: of one over each in-focus depth as it is built, dioptres, standard deviation.
        covered: probability that a finger covers one lens.
        drift: what moves after the calibration.
        level: how much of the better outcomes is left out, from 0 (mean) to 1 (worst case).
        samples: how many devices are drawn.
        seed: of the devices.
    """

    shift: float = 0.0
    focus_dioptre: float = 0.0
    covered: float = 0.0
    drift: DriftConfig = field(default_factory=DriftConfig)
    level: float = 0.0
    samples: int = 64
    seed: int = 0


@dataclass
class ToleranceConfig:
    """How far off a measured depth may be; where both are given both are kept.

    Args:
        mm: at every depth; null for no such limit.
        percent: of the depth; null for no such limit.
    """

    mm: float | None = None
    percent: float | None = None


@dataclass
class PenaltyConfig:
    """What a start pays for room that is not there.

    Args:
        name: distance or area.
    """

    name: PenaltyName = MISSING


@dataclass
class SearchConfig:
    """How long and how widely to search.

    Args:
        starts: how many descend.
        patience: waves of variations without progress after which the search ends.
        proof: boxes of apertures that the lower bound may look at; 0 seeks none.
        seed: of the starts.
        time_limit: s; null for none.
    """

    starts: int = MISSING
    patience: int = MISSING
    proof: int = MISSING
    seed: int = 0
    time_limit: float | None = None


@dataclass
class SweepConfig:
    """How the jobs of a sweep go together.

    Args:
        agree: whether each is tried from its neighbours' layouts once all are done.
    """

    agree: bool = True


@dataclass
class Config:
    """Everything that a run is made from.

    Args:
        name: of the run, part of its folder's name.
        back: where lenses may stand.
        lenses: what is known of each.
        depth: where depth is to be measured.
        field_of_view: how far from straight ahead.
        cues: ways to measure it.
        scene: what the photometric ones look at.
        metric: which error of all depths counts.
        fusion: what is made of several measurements of one depth.
        robust: what sets devices apart from the one that is drawn.
        tolerance: within which the design's working range is told.
        penalty: for room that is not there.
        search: how long and how widely.
        sweep: how its jobs go together, where it is one.
    """

    name: str = MISSING
    back: BackConfig = field(default_factory=BackConfig)
    lenses: LensesConfig = field(default_factory=LensesConfig)
    depth: DepthConfig = field(default_factory=DepthConfig)
    field_of_view: FieldOfViewConfig = field(default_factory=FieldOfViewConfig)
    cues: CuesConfig = field(default_factory=CuesConfig)
    scene: SceneConfig = field(default_factory=SceneConfig)
    metric: MetricConfig = field(default_factory=MetricConfig)
    fusion: FusionConfig = field(default_factory=FusionConfig)
    robust: RobustConfig = field(default_factory=RobustConfig)
    tolerance: ToleranceConfig = field(default_factory=ToleranceConfig)
    penalty: PenaltyConfig = field(default_factory=PenaltyConfig)
    search: SearchConfig = field(default_factory=SearchConfig)
    sweep: SweepConfig = field(default_factory=SweepConfig)


def register() -> None:
    """Make the schema known to Hydra; doing so again changes nothing."""
    ConfigStore.instance().store(name=SCHEMA, node=Config, provider="multilens")
