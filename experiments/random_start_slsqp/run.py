"""Run the default search and 200 random-start SLSQP runs on the same problems, and write the table.

python experiments/random_start_slsqp/run.py
"""

from math import sqrt
from pathlib import Path
from time import process_time

import numpy as np
from hydra import compose, initialize_config_dir
from peer import Peer

import multilens as ml
from multilens.app.build import build_problem, typed
from multilens.app.compose import config_folder
from multilens.app.schema import register
from multilens.search.legalise import legalise
from multilens.search.threads import one_thread
from multilens.storage import write_whole
from multilens.table_text import csv_text, markdown_text

RESULTS = Path(__file__).parent / "results"
RUNS = 200
SEED = 0
"""Of the peer's starts and of the search, fixed before the first run."""

PROBLEMS = (
    ("four lenses, whole back", ["experiment=demo"]),
    ("four lenses, camera island", ["experiment=phone_back_island"]),
    ("six lenses, camera island", ["experiment=phone_back_island", "lenses.count=6", "lenses.lens.clearance=4"]),
)


def problem_of(overrides: list[str]) -> ml.Problem:
    """Give the problem of a preset."""
    register()
    with initialize_config_dir(str(config_folder()), version_base="1.3"):
        return build_problem(typed(compose("config", overrides)))


def peer_scores(problem: ml.Problem, runs: int) -> tuple[list[float], float]:
    """Give the score of every feasible run by the library's own referee, least first, and the processor seconds of all runs."""
    peer, random = Peer(problem), np.random.default_rng(SEED)
    began = process_time()
    ends = [peer.run(peer.random_start(random)) for _ in range(runs)]
    seconds = process_time() - began
    legal = [legalise(problem, peer.layout(end)) for end in ends if np.isfinite(end).all()]
    return sorted(problem.score(layout).item() for layout, certificate in legal if certificate.feasible), seconds


def main() -> None:
    rows = []
    for title, overrides in PROBLEMS:
        problem = problem_of(overrides)
        began = process_time()
        design = ml.solve(problem, seed=SEED)
        seconds = process_time() - began
        with one_thread():
            scores, peer_seconds = peer_scores(problem, RUNS)
        within = sum(score <= design.score * 1.001 for score in scores)
        rows.append(
            {
                "problem": title,
                "multilens RMSE (mm)": f"{design.rmse:.6f}",
                "multilens processor time (s)": f"{seconds:.1f}",
                "best SLSQP RMSE (mm)": f"{sqrt(scores[0]):.6f}",
                "median SLSQP RMSE (mm)": f"{sqrt(np.median(scores)):.6f}",
                f"processor time of {RUNS} SLSQP runs (s)": f"{peer_seconds:.1f}",
                "feasible SLSQP runs": str(len(scores)),
                "SLSQP runs within 0.1 % of multilens' score": str(within),
            }
        )
        print("\n".join(f"{key}: {value}" for key, value in rows[-1].items()), end="\n\n")
    RESULTS.mkdir(exist_ok=True)
    table = [list(rows[0]), *(list(row.values()) for row in rows)]
    write_whole(RESULTS / "table.csv", csv_text(table))
    write_whole(RESULTS / "table.md", markdown_text(table))


if __name__ == "__main__":
    main()
