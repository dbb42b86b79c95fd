"""Which runs there are, and how long each may take."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from math import inf

from benchmark.best_known import Entry, improved, load
from benchmark.lanes import CORES, Lanes
from benchmark.measures import TIE, VERY_CLOSE, Run, is_settled, median_of, stopped_too_early, time_to
from benchmark.methods import OURS, PEERS, RIVAL
from benchmark.problems import Case
from benchmark.report import aimed_ratio

MARGIN = 0.05
"""By which the rival may take longer than the aim asks, so that its limit is not itself the answer."""


def everything(
    lanes: Lanes, cases: Sequence[Case], seeds: Sequence[int], limit: float
) -> tuple[list[Run], dict[str, Entry]]:
    """Give all runs of all methods, and what is known with them.

    Args:
        lanes: where they run.
        cases: the problems.
        seeds: of the search and of its rival; the others run with the first.
        limit: of every run, s; the rival's may go on beyond it.
    """
    known = load()
    with ThreadPoolExecutor(CORES) as threads:
        # Two problems at a time: while one waits for its last run, the other has the core.
        each = threads.map(lambda case: _runs(lanes, case, seeds, limit, known.get(case.name)), cases)
        runs = [run for some in each for run in some]
    known, whole = _with(known, cases, runs), set[int]()
    while early := {at for at, run in enumerate(runs) if stopped_too_early(run, known[run.case].score)} - whole:
        waiting = {at: _begun(lanes, runs[at].case, runs[at].method, runs[at].seed, runs[at].limit) for at in early}
        runs = [waiting[at]() if at in early else run for at, run in enumerate(runs)]
        known, whole = _with(known, cases, runs), whole | early
    return runs, known


def _with(known: Mapping[str, Entry], cases: Sequence[Case], runs: Sequence[Run]) -> dict[str, Entry]:
    known = dict(known)
    for case in cases:
        known = improved(
            known, case, [(run.method, each) for run in runs if run.case == case.name for each in run.found]
        )
    return known


def _runs(lanes: Lanes, case: Case, seeds: Sequence[int], limit: float, known: Entry | None) -> list[Run]:
    goal = known.score * (1 + TIE / 2) if known else 0.0

    def begin(name: str, some: Sequence[int], limit: float = limit) -> list[Callable[[], Run]]:
        return [_begun(lanes, case.name, name, seed, limit, goal) for seed in some]

    ours, others = begin(OURS, seeds), [begin(name, seeds[:1]) for name in PEERS if name != RIVAL]
    runs = [run() for run in ours]
    longer = _time_of_the_rival(case, runs, limit, known)
    # Once most of the rival's runs have missed their longer limit its time is known to be beyond.
    most = len(seeds) // 2 + 1
    theirs = [run() for run in begin(RIVAL, seeds[:most], longer)]
    target = _target(runs, known)
    missed = is_settled([time_to(run, target) for run in theirs], len(seeds))
    last = begin(RIVAL, seeds[most:], limit if missed else longer)
    return [*runs, *theirs, *(run() for run in last), *(run() for some in others for run in some)]


def _begun(lanes: Lanes, case: str, name: str, seed: int, limit: float, goal: float = 0.0) -> Callable[[], Run]:
    """Have a run begin when a core is free, and give what waits for it."""
    wait = lanes.run(name, case, seed, limit, goal)

    def run() -> Run:
        outcome = wait()
        done = Run(case, name, seed, limit, outcome.seconds, tuple(outcome.judged), outcome.failure)
        _tell(done)
        return done

    return run


def _time_of_the_rival(case: Case, ours: Sequence[Run], limit: float, known: Entry | None) -> float:
    """Give how long the rival may go on: until its time shows whether the search is as many times faster as it shall be."""
    target = _target(ours, known)
    needed = median_of([time_to(run, target) for run in ours])
    return max(limit, (1 + MARGIN) * aimed_ratio(case) * needed) if needed < inf else limit


def _target(runs: Sequence[Run], known: Entry | None) -> float:
    """Give the score within 0.1 % of the best that is known by now, mm^2."""
    scores = [each.score for run in runs for each in run.found] + ([known.score] if known else [])
    return min(scores, default=inf) * (1 + VERY_CLOSE)


def _tell(run: Run) -> None:
    last = f"{run.found[-1].score:.7g} mm^2 at {run.found[-1].seconds:.2f} s" if run.found else "nothing"
    # In one piece, for two threads tell.
    line = f"{run.case:22} {run.method:24} seed {run.seed}: {last}, took {run.seconds:.2f} s {run.failure}\n"
    print(line, end="", flush=True)
