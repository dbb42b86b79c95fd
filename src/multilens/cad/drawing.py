"""What is read from any file, and how a back is made of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count

from shapely.affinity import scale
from shapely.errors import ShapelyError

from multilens.back import Back, KeepOut
from multilens.cad.curve import Curve
from multilens.cad.layers import KEEP_OUTS, OUTLINE, clean
from multilens.cad.shapes import shape_of
from multilens.geometry.shape import Shape

MOST_KEEP_OUTS = 256
MOST_CURVES = 256
"""That make one outline or one keep-out."""

MICROMETRE = 3
"""Decimals of a millimetre that are told."""

MOST_NAMED = 20
"""Layers that a message names."""


@dataclass(frozen=True, eq=False)
class Part:
    """One thing in a drawing.

    Args:
        layers: names by which it can be asked for: its layer or groups, its own name.
        curves: that bound it, mm.
        name: what it is called; empty where nothing says it.
        clearance: that bodies keep from it, mm; None where nothing says it.
        fault: why it bounds nothing, which is told where it is asked for; then it has no curves.
    """

    layers: tuple[str, ...]
    curves: tuple[Curve, ...] = ()
    name: str = ""
    clearance: float | None = None
    fault: str = ""


@dataclass(frozen=True)
class Drawing:
    """What was found in a file, in millimetres on the file's axes.

    Args:
        parts: in the order of the file.
        y_up: whether y grows upwards, as in CAD and GIS; on a back it grows downwards.
    """

    parts: tuple[Part, ...]
    y_up: bool

    @property
    def layers(self) -> tuple[str, ...]:
        """Give the name of every layer, in the order of the file."""
        return tuple(dict.fromkeys(name for part in self.parts for name in part.layers))


@dataclass(frozen=True)
class Wanted:
    """What a user wants of a file.

    Args:
        outline: layer of the outline; everything on it together is the outline.
        keep_outs: layers of the keep-outs, () for none; each thing on them is one. None takes the layer `KEEP_OUTS` where there is
            one.
        clearance: that bodies keep from a keep-out of which the file does not say it, mm.
        tolerance: by which rims that cannot be exact may move, to the safe side, mm.
    """

    outline: str = OUTLINE
    keep_outs: tuple[str, ...] | None = None
    clearance: float = 0.0
    tolerance: float = 0.01


@dataclass(frozen=True)
class BackRead:
    """A back that was read, and what is worth telling of it.

    Args:
        back: on its own axes.
        moved: name of each shape whose rim is not exact, and by how much it may have moved, mm.
        left: layers of the file that were not used.
    """

    back: Back
    moved: dict[str, float]
    left: tuple[str, ...]

    def __str__(self) -> str:
        left, top, right, bottom = (round(bound, MICROMETRE) for bound in self.back.outline.bounds)
        size = f"{right - left:.6g} x {bottom - top:.6g} mm"
        lines = [f"outline: {size}, from ({left:g}, {top:g}) to ({right:g}, {bottom:g})"]
        lines.append(f"keep-outs: {', '.join(keep_out.name for keep_out in self.back.keep_outs) or 'none'}")
        if self.moved:
            by = max(self.moved.values())
            lines.append(f"cut into edges, on the safe side by at most {by:g} mm: {', '.join(self.moved)}")
        if self.left:
            more = ", ..." if len(self.left) > MOST_NAMED else ""
            lines.append(f"layers not used: {', '.join(map(clean, self.left[:MOST_NAMED]))}{more}")
        return "\n".join(lines)


def back_of(drawing: Drawing, wanted: Wanted) -> BackRead:
    """Make a back of the layers that are wanted.

    Raises:
        ValueError: a layer is missing, or what is on it is no shape; the layer or keep-out is named.
    """
    on_outline = _on(drawing, wanted.outline, "the outline")
    outline, moved = _shape("outline", [curve for part in on_outline for curve in part.curves], True, drawing, wanted)
    by = {"outline": moved} if moved else {}
    keep_outs = []
    for name, part in (kept := _named_keep_outs(drawing, wanted)).items():
        shape, moved = _shape(f"keep-out {name}", part.curves, False, drawing, wanted)
        by |= {name: moved} if moved else {}
        keep_outs.append(KeepOut(name, shape, wanted.clearance if part.clearance is None else part.clearance))
    return BackRead(Back(outline, tuple(keep_outs)), by, _left(drawing, [*on_outline, *kept.values()]))


def _left(drawing: Drawing, used: Sequence[Part]) -> tuple[str, ...]:
    """Give the outermost layer, of which nothing was used, of each part that was not."""
    names = {name for part in used for name in part.layers}
    left = ([name for name in part.layers if name not in names][:1] for part in drawing.parts if part not in used)
    return tuple(dict.fromkeys(name for outermost in left for name in outermost))


def _shape(name: str, curves: Sequence[Curve], within: bool, drawing: Drawing, wanted: Wanted) -> tuple[Shape, float]:
    if len(curves) > MOST_CURVES:
        raise ValueError(f"{name} must be at most {MOST_CURVES} curves, got {len(curves)}")
    try:
        shape, moved = shape_of(curves, within, wanted.tolerance)
    except (ValueError, ShapelyError) as error:
        raise ValueError(f"{name}: {error}") from None
    if drawing.y_up:
        shape = Shape(scale(shape.core, 1, -1, origin=(0, 0)), shape.radius)
    return shape, moved


def _named_keep_outs(drawing: Drawing, wanted: Wanted) -> dict[str, Part]:
    """Give each keep-out by a name of its own: its own name, else that of its layer, with a number where it is taken."""
    named: dict[str, Part] = {}
    usual = tuple(name for name in drawing.layers if name.casefold() == KEEP_OUTS)
    for layer in usual if wanted.keep_outs is None else wanted.keep_outs:
        for part in _on(drawing, layer, "keep-outs"):
            if part in named.values():
                continue
            called = clean(part.name) or ("keep-out" if layer.casefold() == KEEP_OUTS else clean(layer))
            numbered = (called if number == 1 else f"{called} {number}" for number in count(1))
            named[next(name for name in numbered if name not in named)] = part
            if len(named) > MOST_KEEP_OUTS:
                raise ValueError(f"keep-outs must be at most {MOST_KEEP_OUTS}, got more")
    return named


def _on(drawing: Drawing, layer: str, what: str) -> list[Part]:
    """Give what is on a layer, refused unless there is something and all of it bounds something."""
    found = [part for part in drawing.parts if layer.casefold() in map(str.casefold, part.layers)]
    for part in found:
        if part.fault:
            raise ValueError(f"layer {clean(layer)} of {what}: {part.fault}")
    if not found:
        there = ", ".join(map(clean, drawing.layers[:MOST_NAMED])) or "none"
        raise ValueError(
            f"layer {clean(layer)} of {what} must hold closed curves, got none there; the file has the layers {there}"
        )
    return found
