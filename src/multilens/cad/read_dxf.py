"""DXF, by ezdxf: closed curves of every layer, and loops of lines and arcs that meet."""

# ezdxf documents the names that are taken from it, and does not list them as exported.
# pyright: reportPrivateImportUsage=false

from collections.abc import Iterator, Sequence
from io import StringIO
from math import hypot

import ezdxf
import numpy as np
from ezdxf import edgeminer, edgesmith, upright
from ezdxf.document import Drawing as Document
from ezdxf.entities import Circle, DXFEntity, DXFGraphic, DXFTagStorage, Ellipse, LWPolyline, Polyline, Spline
from ezdxf.enums import InsertUnits
from ezdxf.lldxf.const import DXFError
from ezdxf.units import conversion_factor

from multilens.cad.curve import Curve, circle, tidy
from multilens.cad.drawing import Drawing, Part
from multilens.cad.units import scale_of

APPLICATION = "MULTILENS"
"""Under which our own files say the name and the clearance of a keep-out."""

TOUCHING = 1e-3
"""mm; ends of lines and arcs that are no farther apart meet."""

FLAT = 1e-9
"""By how much a direction may lean away from straight up."""

FINER = 4
"""Splines and ellipses are cut this much finer than asked for: how far they are off is only estimated."""

NOTES = {
    "TEXT",
    "MTEXT",
    "DIMENSION",
    "ARC_DIMENSION",
    "LEADER",
    "MULTILEADER",
    "POINT",
    "ATTDEF",
    "VIEWPORT",
    "IMAGE",
    "WIPEOUT",
}
"""Types of entity that bound nothing and are passed over."""

CURVES = {"LINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "LWPOLYLINE", "POLYLINE"}


# What is not finite numpy warns of; a curve refuses it.
@np.errstate(all="ignore")
def read_dxf(text: str, units: str | None, tolerance: float) -> Drawing:
    """Read the model space of a drawing, y upwards; heights above the plane are not looked at.

    Args:
        text: of the file.
        units: told by the user; None for those of the file.
        tolerance: within which splines and ellipses are cut into edges, mm.

    Raises:
        ValueError: it is no DXF, or the units are unknown.
    """
    try:
        document = ezdxf.read(StringIO(text))
    except (DXFError, ValueError, ArithmeticError, LookupError, AttributeError, TypeError, RecursionError) as error:
        raise ValueError(f"DXF must be whole, got {type(error).__name__}: {error}") from None
    factor = scale_of(units, _units(document), f"$INSUNITS={document.units}", "units=mm")
    layers: dict[str, list[DXFEntity]] = {}
    for entity in document.modelspace():
        if entity.dxftype() not in NOTES:
            layers.setdefault(_layer(entity), []).append(entity)
    parts = [part for layer, entities in layers.items() for part in _parts(layer, entities, factor, tolerance)]
    return Drawing(tuple(_together(parts)), y_up=True)


def _layer(entity: DXFEntity) -> str:
    """Give the layer of an entity, also of one of a type that ezdxf knows nothing else of."""
    if isinstance(entity, DXFTagStorage):
        return str(entity.graphic_properties().get("layer", "0"))
    return entity.dxf.layer


def _units(document: Document) -> float | None:
    return (
        None if document.units == 0 else float(conversion_factor(InsertUnits(document.units), InsertUnits.Millimeters))
    )


def _parts(layer: str, entities: Sequence[DXFEntity], factor: float, tolerance: float) -> Iterator[Part]:
    loose = []
    for entity in entities:
        try:
            _refuse_unless_flat(entity)
            curve = _closed(entity, factor, tolerance)
            if curve is None:
                loose.append(entity)
            else:
                yield Part((layer,), (curve,), *_said(entity, factor))
        except ValueError as error:
            yield Part((layer,), fault=f"a {entity.dxftype()} {error}")
        except RecursionError:
            yield Part((layer,), fault=f"a {entity.dxftype()} must not bend without measure")
    yield from _loops(layer, loose, factor, tolerance)


def _refuse_unless_flat(entity: DXFEntity) -> None:
    """Refuse what is no curve in the plane of x and y; one drawn from below is turned to the same curve from above."""
    if entity.dxftype() not in CURVES:
        raise ValueError("cannot be read: explode it into curves, or put it on another layer")
    assert isinstance(entity, DXFGraphic)
    upright.upright(entity)
    across, along, up = entity.dxf.get("extrusion", (0, 0, 1))
    if max(abs(across), abs(along)) > FLAT * up:
        raise ValueError("must lie in the plane of x and y, got one that is tilted")


def _closed(entity: DXFEntity, factor: float, tolerance: float) -> Curve | None:
    """Give a closed entity as a curve, and None for any other."""
    if isinstance(entity, Circle) and entity.dxftype() == "CIRCLE":
        return circle((factor * entity.dxf.center.x, factor * entity.dxf.center.y), factor * entity.dxf.radius)
    if not edgesmith.is_closed_entity(entity):
        return None
    if isinstance(entity, LWPolyline):
        return _bulged(np.array(list(entity.get_points("xyb"))), factor)
    if isinstance(entity, Polyline) and entity.is_2d_polyline:
        return _bulged(np.array([(*v.dxf.location.vec2, v.dxf.bulge) for v in entity.vertices]), factor)
    if isinstance(entity, Spline | Ellipse):
        points = entity.flattening(tolerance / factor / 2 / FINER)
        return _along(np.array([(point.x, point.y) for point in points]), factor)
    return None


def _bulged(rows: np.ndarray, factor: float) -> Curve:
    return tidy(factor * rows[:, :2], rows[:, 2])


def _along(points: np.ndarray, factor: float) -> Curve:
    return tidy(factor * points, np.zeros(len(points)), exact=False)


def _said(entity: DXFEntity, factor: float) -> tuple[str, float | None]:
    """Give the name and the clearance that one of our own files says."""
    if not entity.has_xdata(APPLICATION):
        return "", None
    tags = entity.get_xdata(APPLICATION)
    names, clearances = ([tag.value for tag in tags if tag.code == code] for code in (1000, 1040))
    return (names or [""])[0], factor * clearances[0] if clearances else None


def _loops(layer: str, loose: list[DXFEntity], factor: float, tolerance: float) -> Iterator[Part]:
    """Put lines and arcs together where their ends meet."""
    gap = TOUCHING / factor
    edges = list(edgesmith.edges_from_entities_2d(loose, gap_tol=gap))
    chains = edgeminer.find_all_simple_chains(edgeminer.Deposit(edges, gap_tol=gap)) if edges else ()
    for chain in sorted(chains, key=lambda chain: min(int(edge.payload.dxf.handle, 16) for edge in chain)):
        (x0, y0, *_), (x1, y1, *_) = chain[0].start, chain[-1].end
        if (apart := hypot(x1 - x0, y1 - y0)) > gap:
            where = f"({factor * x0:g}, {factor * y0:g}) to ({factor * x1:g}, {factor * y1:g}) mm"
            yield Part((layer,), fault=f"curve must be closed, got ends {factor * apart:g} mm apart, from {where}")
            continue
        try:
            yield Part((layer,), (_joined(chain, factor, tolerance),))
        except ValueError as error:
            yield Part((layer,), fault=f"lines and arcs that meet: {error}")
        except RecursionError:
            yield Part((layer,), fault="lines and arcs that meet must not bend without measure")


def _joined(chain: Sequence[edgeminer.Edge], factor: float, tolerance: float) -> Curve:
    joined = edgesmith.lwpolyline_from_chain(chain, max_sagitta=tolerance / factor / 2 / FINER)
    curve = _bulged(np.array(list(joined.get_points("xyb"))), factor)
    smooth = all(edge.payload.dxftype() not in ("SPLINE", "ELLIPSE") for edge in chain)
    return _begun_alike(curve, smooth)


def _begun_alike(curve: Curve, exact: bool) -> Curve:
    """Give a curve from its first corner on, counter-clockwise: in what order loose edges are joined is nobody's choice."""
    points, bulges = curve.points, curve.bulges
    x, y = points.T
    if (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() < 0:
        points, bulges = points[::-1], -np.roll(bulges[::-1], -1)
    first = np.lexsort((points[:, 1], points[:, 0]))[0]
    return Curve(np.roll(points, -first, axis=0), np.roll(bulges, -first), exact)


def _together(parts: Sequence[Part]) -> Iterator[Part]:
    """Make one of the curves that our own files call by one name: a keep-out's shell and its holes."""
    named: dict[tuple[tuple[str, ...], str], list[Part]] = {}
    for index, part in enumerate(parts):
        named.setdefault((part.layers, part.name or f"\0{index}"), []).append(part)
    for same in named.values():
        first = same[0]
        curves = tuple(curve for part in same for curve in part.curves)
        yield Part(first.layers, curves, first.name, first.clearance, first.fault)
