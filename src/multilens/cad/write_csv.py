"""A layout as a table: a row for each lens, on the axes of the back."""

from multilens.cad.plan import Plan, Stand
from multilens.table_text import csv_text

HEAD = (
    "lens",
    "x_mm",
    "y_mm",
    "aperture_radius_mm",
    "f_number",
    "focus_mm",
    "body_radius_mm",
    "focal_length_mm",
    "name",
)


def write_csv(plan: Plan) -> str:
    """Give the lenses as comma-separated text, in the units that the head of each column names.

    Raises:
        ValueError: there are none.
    """
    if not plan.stands:
        raise ValueError("a table must have lenses, got a back alone")
    return csv_text([HEAD, *map(_row, plan.stands)])


def _row(stand: Stand) -> tuple[int | float | str, ...]:
    foci = ";".join(map(repr, stand.foci))
    aperture, body = (stand.aperture_radius, stand.f_number, foci), (stand.body_radius, stand.focal_length)
    return (stand.number, stand.x, stand.y, *aperture, *body, stand.called)
