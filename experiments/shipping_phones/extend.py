"""An iPhone 15 Pro Max with one or two cameras more: Apple's three stay where they are, the new ones go where they help most."""

from dataclasses import replace
from math import pi
from pathlib import Path

from matplotlib.figure import Figure
from phones import SEED

import multilens as ml
from multilens.app.build import build_problem
from multilens.app.given import read_given
from multilens.plot.figures import overview_figure

SMALL = 2.6
"""Clearance of a camera in a small body, mm; with f/1.78 it is 9 mm across, of the size of a phone's front camera: a choice."""


def asked(back: str, added: int, small: bool) -> ml.Problem:
    """Give the phone with more main cameras, free, on a back.

    Args:
        back: the whole back or the island.
        added: how many.
        small: whether the new cameras have the small body instead of Apple's shroud.
    """
    problem = build_problem(read_given(["experiment=devices/iphone_15_pro_max", f"back={back}"]).config)
    main = replace(problem.lenses[1], position=None)
    new = replace(main, clearance=SMALL) if small else main
    return replace(problem, lenses=[*problem.lenses, *[new] * added])


CASES = (
    ("island", "iphone_15_pro_max_island", True),
    ("back", "iphone_15_pro_max", False),
)


def extension_table(folder: Path) -> tuple[list[dict[str, str]], dict[str, Figure]]:
    """Search one and two cameras more, save the designs and say what each gains."""
    rows, figures = [], {}
    for name, back, small in CASES:
        before = ml.evaluate(asked(back, 0, small), seed=SEED)
        rows.append(row(name, before, before, 0))
        for added in (1, 2):
            after = ml.solve(asked(back, added, small), seed=SEED)
            rows.append(row(name, before, after, added))
            if not after.feasible:
                continue
            replace(after, convergence=None).save(folder / f"extended_{name}_{added}.json")
            assert isinstance(after.problem, ml.Problem)
            figures[f"extended_{name}_{added}"] = overview_figure(after.problem, after.layout)
    return rows, figures


def row(name: str, before: ml.Design, after: ml.Design, added: int) -> dict[str, str]:
    """Give a line of the table: the gain of each lens, and of each mm^2 that the new bodies take."""
    line = {"new cameras on the": name, "added": str(added)}
    if not after.feasible:
        return line | {
            "RMSE (mm)": after.reason,
            "gain": "",
            "per lens (mm)": "",
            "per mm^2 of body (mm)": "",
            "places": "",
        }
    gain = before.rmse - after.rmse
    new = list(zip(after.problem.lenses, after.layout.aperture_radius.tolist(), strict=True))[3:]
    area = sum(pi * (radius + lens.clearance) ** 2 for lens, radius in new)
    spots = " ".join(f"({x:.1f}, {y:.1f})" for x, y in after.layout.position.tolist()[3:])
    return line | {
        "RMSE (mm)": f"{after.rmse:.4f}",
        "gain": f"{100 * gain / before.rmse:.1f} %" if added else "",
        "per lens (mm)": f"{gain / added:.4f}" if added else "",
        "per mm^2 of body (mm)": f"{gain / area:.5f}" if added else "",
        "places": spots,
    }
