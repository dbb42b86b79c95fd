"""A layout and its certificate as plain data and back."""

from collections.abc import Sequence

from multilens.certificate import Certificate, Clearance
from multilens.fields import flag, items, number, numbers, record, text
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.records.nouns import Record


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
        what, room = text(fields["what"], f"{place}.what"), number(fields["room"], f"{place}.room")
        clearances.append(Clearance(what, room, flag(fields["kept"], f"{place}.kept")))
    return Certificate(tuple(clearances))
