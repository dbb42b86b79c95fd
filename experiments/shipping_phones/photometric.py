"""The same phones by texture, light and noise: pairs that need overlap and focus, defocus that no longer is perfect at Zf."""

from dataclasses import replace
from pathlib import Path

from phones import PHONES, SEED, Phone, freed

import multilens as ml

WORDS = ("cues=photometric", "metric=relative")

STARTS, PATIENCE = 32, 2
"""Of the search, which takes longer here; no lower bound is known for these cues."""


def photometric_rows(folder: Path) -> list[dict[str, str]]:
    """Score every phone as it ships and search its island, save the designs and give a line for each."""
    rows = []
    for phone in PHONES:
        problem = phone.problem(*WORDS)
        shipped = ml.evaluate(problem, seed=SEED)
        best = ml.solve(freed(problem, phone.island), STARTS, SEED, patience=PATIENCE)
        # As it ships is one of the layouts that are possible: a search that finds no better one has found this one.
        best = best if best.score < shipped.score else shipped
        replace(best, convergence=None).save(folder / f"{phone.name}_photometric.json")
        rows.append(row(phone, shipped, best))
        print(rows[-1], flush=True)
    return rows


def row(phone: Phone, shipped: ml.Design, best: ml.Design) -> dict[str, str]:
    """Give a phone's line of the table."""
    line = {"phone": phone.title, "places": "published" if phone.published else "estimated"}
    for name, design in (("as shipped", shipped), ("best", best)):
        problem = design.problem
        assert isinstance(problem, ml.Problem)
        errors = problem.errors(design.layout).amin(-2)
        at = [(problem.depths - depth).abs().argmin() for depth in (300, 1000, 5000)]
        told = " ".join(f"{100 * errors[k].item() / problem.depths[k].item():.2g}" for k in at)
        line |= {
            f"relative RMSE, {name} (%)": f"{design.figure:.3g}",
            f"error at 0.3, 1 and 5 m, {name} (%)": told,
        }
    return line
