from functools import partial

import multilens as ml
from benchmark.cues import cues_table


def test_every_kind_of_cue_is_timed_and_held_against_the_best_of_all() -> None:
    quick = partial(ml.solve, starts=4, proof=0)

    def solve(problem: ml.Problem, seed: int, patience: int = 0) -> ml.Design:
        return quick(problem, seed=seed, patience=min(patience, 1))

    _, thesis, photometric = cues_table(solve, seeds=(0,))
    assert (thesis[0], thesis[2], photometric[0]) == ("thesis", 1.0, "photometric")
    assert thesis[3] >= 0
    assert photometric[4] >= photometric[3] >= 0
