"""A layout as a table to read: a line for each lens."""

from collections.abc import Callable, Sequence

from multilens.layout import Layout
from multilens.lens import Lens, telling_names

HEAD = ("lens", "x (mm)", "y (mm)", "aperture radius (mm)", "f-number", "focus (mm)")


def f_numbers(layout: Layout, lenses: Sequence[Lens]) -> tuple[float, ...]:
    """Give N = f / (2 A) of each lens of one layout."""
    radii = layout.aperture_radius.tolist()
    return tuple(lens.focal_length / (2 * radius) for lens, radius in zip(lenses, radii, strict=True))


def foci(layout: Layout, lenses: Sequence[Lens]) -> tuple[tuple[float, ...], ...]:
    """Give the in-focus depth of each tier that each lens of one layout has, mm."""
    return tuple(tuple(row[: lens.tiers]) for row, lens in zip(layout.focus.tolist(), lenses, strict=True))


def layout_lines(layout: Layout, lenses: Sequence[Lens]) -> list[str]:
    """Give the head and a line for each lens, in columns; with the lenses' names where they tell one from another."""
    numbers = zip(
        layout.position.tolist(),
        layout.aperture_radius.tolist(),
        f_numbers(layout, lenses),
        foci(layout, lenses),
        strict=True,
    )
    rows = [
        (f"{i + 1}", f"{x:.3f}", f"{y:.3f}", f"{radius:.3f}", f"{f_number:.2f}", ", ".join(f"{z:.1f}" for z in depths))
        for i, ((x, y), radius, f_number, depths) in enumerate(numbers)
    ]
    columns = [_justified(column, str.rjust) for column in zip(HEAD, *rows, strict=True)]
    names = telling_names(lenses)
    if names:
        columns.insert(1, _justified(("name", *names), str.ljust))
    return ["  ".join(line).rstrip() for line in zip(*columns, strict=True)]


def _justified(cells: Sequence[str], justify: Callable[[str, int], str]) -> list[str]:
    width = max(map(len, cells))
    return [justify(cell, width) for cell in cells]
