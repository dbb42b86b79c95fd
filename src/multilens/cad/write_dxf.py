"""A plan as DXF, by ezdxf: in millimetres, y upwards, a layer for each kind of thing."""

# ezdxf documents the names that are taken from it, and does not list them as exported.
# pyright: reportPrivateImportUsage=false

from collections.abc import Iterator
from contextlib import contextmanager
from io import StringIO

import ezdxf
import numpy as np
from ezdxf.enums import TextEntityAlignment
from ezdxf.layouts import Modelspace
from ezdxf.units import MM

from multilens.cad.labels import labels
from multilens.cad.layers import APERTURES, BASELINES, BODIES, KEEP_OUTS, LABELS, OUTLINE, clean
from multilens.cad.plan import Plan
from multilens.cad.read_dxf import APPLICATION
from multilens.cad.rims import bare, rims
from multilens.geometry.shape import Shape

VERSION = "R2010"
"""The first in UTF-8 that programs everywhere have read for years."""

COLOURS = {OUTLINE: 7, KEEP_OUTS: 1, BODIES: 8, APERTURES: 5, BASELINES: 9, LABELS: 7}
"""Of AutoCAD's index: black or white, red, grey, blue, light grey."""

TEXT = 0.012
"""Height of words, as a part of the diagonal of the back."""


def write_dxf(plan: Plan) -> str:
    """Give a drawing with true circles and arcs; the same plan gives the same bytes."""
    plan = plan.turned()
    with _without_time():
        document = ezdxf.new(VERSION, units=MM)
        document.appids.add(APPLICATION)
        for layer, colour in COLOURS.items():
            document.layers.add(layer, color=colour)
        _draw(plan, document.modelspace())
        # ezdxf declares what it writes in the order of a set, which differs from run to run.
        for kind in sorted(document.entitydb.dxf_types_in_use()):
            document.classes.add_class(kind)
        text = StringIO()
        document.write(text)
    return text.getvalue()


@contextmanager
def _without_time() -> Iterator[None]:
    """Have ezdxf write fixed times and identifiers in place of those of the moment."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def _draw(plan: Plan, space: Modelspace) -> None:
    _draw_shape(space, plan.back.outline, OUTLINE, [])
    for keep_out in plan.back.keep_outs:
        _draw_shape(space, keep_out.shape, KEEP_OUTS, [(1000, clean(keep_out.name)), (1040, float(keep_out.clearance))])
    for stand in plan.stands:
        for layer, radius in ((BODIES, stand.body_radius), (APERTURES, stand.aperture_radius)):
            space.add_circle((stand.x, stand.y), radius, {"layer": layer})
    for a, b, _ in plan.baselines:
        space.add_line((a.x, a.y), (b.x, b.y), {"layer": BASELINES})
    height = float(f"{TEXT * plan.back.size:.2g}")
    for label in labels(plan, height):
        align = TextEntityAlignment.MIDDLE_CENTER if label.centred else TextEntityAlignment.MIDDLE_LEFT
        text = space.add_text(label.words, height=height, dxfattribs={"layer": LABELS})
        text.set_placement((label.x, label.y), align=align)


def _draw_shape(space: Modelspace, shape: Shape, layer: str, tags: list[tuple[int, str | float]]) -> None:
    for curve in rims(shape):
        if bare(curve):
            entity = space.add_circle((*curve.centres[0].tolist(),), float(shape.radius), {"layer": layer})
        else:
            rows = np.column_stack([curve.points, curve.bulges]).tolist()
            entity = space.add_lwpolyline(rows, "xyb", close=True, dxfattribs={"layer": layer})
        if tags:
            entity.set_xdata(APPLICATION, tags)
