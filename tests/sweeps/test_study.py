"""Explorations whose answers are known in closed form, without a search."""

import os
import signal
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import numpy as np
import pytest

from multilens.sweep_row import FAILED, SweepRow
from multilens.sweeps.space import Choice, Span
from multilens.sweeps.study import JOURNAL, explore, open_study

WIDTH = Span("width", 10.0, 90.0)
COUNT = Span("count", 1, 6, step=1, whole=True)


def row(number, settings, **numbers):
    return SweepRow(number, settings, "complete", **numbers)


def falling(number, settings):
    """Give an error that falls as the width grows."""
    return row(number, settings, rmse=100 / float(dict(settings)["width"]))


def run(folder, compute, space=(WIDTH,), objectives=("rmse",), trials=15, seed=0):
    study = open_study(folder, len(objectives))
    tried = []

    def noted(number, settings):
        tried.append((number, settings))
        return compute(number, settings)

    best = explore(study, folder, space, objectives, trials, seed, noted)
    return best, tried


def test_the_best_of_an_error_that_falls_with_the_width_is_the_widest(tmp_path):
    (best,), tried = run(tmp_path, falling, trials=40)
    widths = [float(dict(settings)["width"]) for _, settings in tried]
    assert widths[best] == max(widths)
    # Of forty random ones the widest would be above 88 with a probability of 0.63; this comes nearer.
    assert widths[best] > 89


def test_as_many_are_tried_as_were_asked_for_each_once(tmp_path):
    _, tried = run(tmp_path, falling)
    assert [number for number, _ in tried] == list(range(15))


def dear_and_wide(number, settings):
    """Give two objectives that pull apart, and a third value of no use to either."""
    count, kind = int(dict(settings)["count"]), dict(settings)["kind"]
    waste = 0.0 if kind == "lean" else 1.0
    return row(number, settings, rmse=1 / count + waste, back_area=float(count) + waste)


def test_the_front_is_that_of_brute_force(tmp_path):
    space, objectives = (COUNT, Choice("kind", ("lean", "fat"))), ("rmse", "back_area")
    best, tried = run(tmp_path, dear_and_wide, space, objectives, trials=60)
    points = np.array([[getattr(dear_and_wide(*each), name) for name in objectives] for each in tried])
    beaten = [((points <= point).all(1) & (points < point).any(1)).any() for point in points]
    assert best == tuple(np.flatnonzero(~np.array(beaten)))
    # On the whole grid the front is every count of the lean kind.
    assert {tuple(dict(tried[number][1]).values()) for number in best} == {(str(n), "lean") for n in range(1, 7)}


def test_the_same_seed_tries_the_same_and_another_does_not(tmp_path):
    tried = []
    for name, seed in (("a", 0), ("b", 0), ("c", 1)):
        (tmp_path / name).mkdir()
        tried.append(run(tmp_path / name, falling, seed=seed)[1])
    assert tried[0] == tried[1]
    assert tried[0] != tried[2]


class Stop(BaseException):
    """As a signal would end it."""


@pytest.mark.parametrize("at", [0, 4, 13])
def test_an_interrupted_exploration_goes_on_as_if_it_had_not_been(at, tmp_path):
    def stopping(number, settings):
        if number == at:
            raise Stop
        return falling(number, settings)

    for name in ("whole", "stopped"):
        (tmp_path / name).mkdir()
    whole = run(tmp_path / "whole", falling)
    with pytest.raises(Stop):
        run(tmp_path / "stopped", stopping)
    best, tried = run(tmp_path / "stopped", falling)
    assert tried == whole[1][at:]
    assert best == whole[0]


def test_a_half_written_line_of_the_record_is_forgotten(tmp_path):
    run(tmp_path, falling, trials=5)
    with (tmp_path / JOURNAL).open("ab") as journal:
        journal.write(b'{"op_code":')
    assert [number for number, _ in run(tmp_path, falling, trials=7)[1]] == [5, 6]


def test_a_record_that_was_altered_is_refused(tmp_path):
    run(tmp_path, falling, trials=2)
    journal = tmp_path / JOURNAL
    journal.write_bytes(journal.read_bytes().replace(b'{"op_code"', b'"op_code"', 2))
    with pytest.raises(ValueError, match=r"."):
        open_study(tmp_path, 1)


def test_what_came_to_nothing_is_no_number_and_is_stayed_away_from(tmp_path):
    """On the upper half nothing fits, and the error falls up to there."""

    def fits(number, settings):
        if float(dict(settings)["width"]) > 50:
            return SweepRow(number, settings, "infeasible", "no room")
        return falling(number, settings)

    (best,), tried = run(tmp_path, fits, trials=40)
    widths = [float(dict(settings)["width"]) for _, settings in tried]
    assert widths[best] == max(width for width in widths if width <= 50)
    states = {trial.number: trial.state.name for trial in open_study(tmp_path, 1).trials}
    assert states == {n: "PRUNED" if width > 50 else "COMPLETE" for n, width in enumerate(widths)}
    # Of random widths a quarter would be above 70.
    assert np.mean([width > 70 for width in widths[10:]]) < 0.1


def test_nothing_is_learned_from_a_fault(tmp_path):
    best, _ = run(tmp_path, lambda number, settings: SweepRow(number, settings, FAILED, "RuntimeError"), trials=3)
    assert best == ()
    assert {trial.state.name for trial in open_study(tmp_path, 1).trials} == {"FAIL"}


WORKER = """
import sys, time
from pathlib import Path
sys.path.insert(0, {tests!r})
from test_study import COUNT, WIDTH, falling
from multilens.sweeps.study import explore, open_study

folder = Path(sys.argv[1])

def compute(number, settings):
    with (folder / "computed").open("a") as file:
        file.write(f"{{number}}\\n")
    time.sleep(0.05)
    return falling(number, settings)

explore(open_study(folder, 1), folder, (WIDTH,), ("rmse",), 12, 0, compute)
"""


def start(folder: Path) -> subprocess.Popen[bytes]:
    return subprocess.Popen([sys.executable, "-c", WORKER.format(tests=str(Path(__file__).parent)), str(folder)])


def computed(folder: Path) -> list[int]:
    file = folder / "computed"
    return [int(line) for line in file.read_text().splitlines()] if file.exists() else []


def test_two_processes_try_each_trial_once(tmp_path):
    workers = [start(tmp_path), start(tmp_path)]
    assert [worker.wait(timeout=60) for worker in workers] == [0, 0]
    assert sorted(computed(tmp_path)) == list(range(12))


def test_a_process_that_was_killed_is_followed_by_one_that_repeats_its_last_trial_alone(tmp_path):
    worker = start(tmp_path)
    deadline = monotonic() + 60
    while len(computed(tmp_path)) < 5 and worker.poll() is None and monotonic() < deadline:
        sleep(0.01)
    os.kill(worker.pid, signal.SIGKILL)
    worker.wait()
    before = computed(tmp_path)
    assert len(before) >= 5
    assert start(tmp_path).wait(timeout=60) == 0
    again = computed(tmp_path)[len(before) :]
    assert again in (list(range(before[-1], 12)), list(range(before[-1] + 1, 12)))
