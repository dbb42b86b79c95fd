"""A layout as a table: a row for each lens, on the axes of the back."""

from multilens.cad.plan import Plan
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
)


def write_csv(plan: Plan) -> str:
    """Give the lenses as comma-separated text, in the units that the head of each column names.

    Raises:
        ValueError: there are none.
    """
    if not plan.stands:
        raise ValueError("a table must have lenses, got a back alone")
    rows = [
        (s.number, s.x, s.y, s.aperture_radius, s.f_number, ";".join(map(repr, s.foci)), s.body_radius, s.focal_length)
        for s in plan.stands
    ]
    return csv_text([HEAD, *rows])
