"""Hold the bounds against noisy images, ask them of a phone's camera, and design four lenses by them; tables and figures.

python experiments/photometric_bound/run.py
"""

from math import inf
from pathlib import Path

import figures
import torch
from cases import (
    BASELINE,
    DEPTHS,
    F_NUMBERS,
    FOCUS,
    LIGHTS,
    defocus_bound,
    phone_errors,
    stereo_bound,
)
from simulate import Camera, defocus_error, stereo_error

import multilens as ml
from multilens.app import build
from multilens.app.given import read_given
from multilens.plot.figures import overview_figure, save_figures
from multilens.plot.style import style
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"
DRAWS, SEED = 40_000, 0
CALLED = {
    "photometric": "by texture, light and noise",
    "wide_open": "the same, all at f/1.78",
    "thesis": "by the thesis' scalars",
}


def simulated() -> dict[str, list[float]]:
    random, camera = torch.Generator().manual_seed(SEED), Camera()
    return {
        "defocus": [defocus_error(camera, depth, DRAWS, random) for depth in DEPTHS],
        "stereo": [stereo_error(camera, depth, BASELINE, DRAWS, random) for depth in DEPTHS],
    }


def bound_table(found: dict[str, list[float]]) -> list[list[str]]:
    depths, camera = torch.tensor(DEPTHS, dtype=torch.float64), Camera()
    bounds = {"defocus": defocus_bound(camera, depths).tolist(), "stereo": stereo_bound(camera, depths).tolist()}
    head = ["depth (mm)"]
    for cue in bounds:
        head += [f"{cue}: noisy images (mm)", f"{cue}: bound (mm)", f"{cue}: images / bound"]
    rows = []
    for i, depth in enumerate(DEPTHS):
        row = [f"{depth:g}"]
        for cue, line in bounds.items():
            row += [f"{found[cue][i]:.4g}", f"{line[i]:.4g}", f"{found[cue][i] / line[i]:.3f}"]
        rows.append(row)
    return [head, *rows]


def phone_table() -> list[list[str]]:
    depths = ml.log_depths(100, 20_000, 4000)
    depths[(depths - FOCUS).abs().argmin()] = FOCUS
    rows = []
    for name, lux in LIGHTS.items():
        for f_number in F_NUMBERS:
            stereo, defocus = phone_errors(lux, f_number, depths)
            row = [name, f"{f_number:g}"]
            for errors in (stereo, defocus):
                row += [_at_focus(errors, depths), _range(errors, depths)]
            rows.append(row)
    cues = ("stereo", "defocus")
    return [["light", "f-number", *(f"{cue}: {what}" for cue in cues for what in ("at 1 m (mm)", "seen (m)"))], *rows]


def _at_focus(errors: torch.Tensor, depths: torch.Tensor) -> str:
    error = errors[depths == FOCUS].item()
    return "-" if error == inf else f"{error:.3g}"


def _range(errors: torch.Tensor, depths: torch.Tensor) -> str:
    seen = depths[errors.isfinite()] / 1000
    if not len(seen):
        return "-"
    far = "beyond 20" if seen[-1] == depths[-1] / 1000 else f"{seen[-1]:.2f}"
    return f"{seen[0]:.2f} to {far}"


def designs() -> dict[str, ml.Design]:
    """Search four lenses on one island by texture, light and noise, the same wide open, and by the thesis' scalars."""
    asked = {
        "photometric": ["experiment=photometric_phone"],
        "wide_open": ["experiment=photometric_phone", "lenses.lens.f_number=[1.78,1.78]"],
        "thesis": ["experiment=phone_back_island"],
    }
    return {name: ml.solve(build.build_problem(read_given(words).config)) for name, words in asked.items()}


def design_table(found: dict[str, ml.Design]) -> list[list[str]]:
    problem = found["photometric"].problem
    assert isinstance(problem, ml.Problem)
    head = ["design", "RMSE by texture, light and noise (mm)", "measured", "aperture radii (mm)", "foci (m)"]
    rows = []
    for name, design in found.items():
        layout = design.layout
        rows.append(
            [
                CALLED[name],
                f"{problem.score(layout).item() ** 0.5:.3f}",
                f"{100 * problem.measured(layout).item():.1f} %",
                " ".join(f"{radius:.2f}" for radius in layout.aperture_radius.tolist()),
                " ".join(f"{focus / 1000:.2f}" for focus in layout.focus.flatten().tolist()),
            ]
        )
    return [head, *rows]


def main() -> None:
    RESULTS.mkdir(exist_ok=True)
    found, answers = simulated(), designs()
    tables = {"bound": bound_table(found), "phone": phone_table(), "designs": design_table(answers)}
    for name, table in tables.items():
        print(markdown_text(table))
        write_whole(RESULTS / f"{name}.csv", csv_text(table))
        write_whole(RESULTS / f"{name}.md", markdown_text(table))
    for name, design in answers.items():
        design.save(RESULTS / f"{name}.json")
    design = answers["photometric"]
    assert isinstance(design.problem, ml.Problem)
    with style():
        pictures = {"bound": figures.bound(found), "phone": figures.phone()}
    save_figures({**pictures, "photometric": overview_figure(design.problem, design.layout)}, RESULTS)


if __name__ == "__main__":
    main()
