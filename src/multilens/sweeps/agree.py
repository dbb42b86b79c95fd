"""Designs of a sweep that agree: each job begins from its neighbours' layouts until that makes none better."""

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import starmap

from multilens.certificate import certify
from multilens.design import Design
from multilens.question import Question
from multilens.records import problem_record
from multilens.search.neighbours import carried_over
from multilens.search.solve import solve
from multilens.sweep_row import in_order
from multilens.sweeps.compute import Compute

Settings = Sequence[tuple[str, str]]
Listener = Callable[[int, int], None]

PROGRESS = 1e-6
"""Part of a score by which a layout must be better to take the place of another: less is a matter of rounding."""

MOST_PASSES = 100
"""Through all jobs. A pass carries what is good two values further; most sweeps need five or less."""


def agree(
    own: Mapping[int, Design],
    settings: Mapping[int, Settings],
    listener: Listener = lambda turn, job: None,
    compute: Compute = starmap,
) -> dict[int, Design]:
    """Give every job the best design that it, or its neighbours' layouts, lead to.

    In each pass a job begins from the layouts that neighbours have come to since it last looked, whole, with lenses added or
    left out, and keeps its own unless it finds a better one. Neighbours are an odd number of steps apart, so first every other
    job looks and then those between them: none has to wait for another within a half. The outcome depends on nothing but what
    is given: not on who computed it, nor in which order.

    Args:
        own: what each job's own search found, feasible, by its number.
        settings: the swept keys and their values of every job, also of those that found nothing.
        listener: told of the pass, from 1, and the job that has been looked at.
        compute: does the work of many jobs, here or elsewhere.

    Returns:
        A design for each of the same jobs, never worse than its own.
    """
    near, steps = unlike_neighbours(own, settings), {job: sum(place) for job, place in _places(settings).items()}
    now, seen = dict(own), {}
    for turn in range(1, MOST_PASSES + 1):
        before = dict(now)
        for half in (0, 1):
            jobs = [job for job in sorted(own) if steps[job] % 2 == half]
            news = {job: [other for other in near[job] if seen.get((job, other)) is not now[other]] for job in jobs}
            seen |= {(job, other): now[other] for job in jobs for other in news[job]}
            # Many lenses take long: begun last, they would leave the other workers waiting for them.
            looking = sorted((job for job in jobs if news[job]), key=lambda job: -len(now[job].problem.lenses))
            tasks = [(now[job], [now[other] for other in news[job]]) for job in looking]
            for job, better in zip(looking, compute(_better_by, tasks), strict=True):
                listener(turn, job)
                now[job] = better or now[job]
        if all(now[job] is before[job] for job in own):
            break
    return now


def unlike_neighbours(own: Mapping[int, Design], settings: Mapping[int, Settings]) -> dict[int, list[int]]:
    """Give for each job that found something those of its neighbours that did, and that were asked another question.

    Jobs that differ in a seed or in the effort alone are there to be compared: they stay as their searches left them.
    """
    asked = {job: _as_text(design.problem) for job, design in own.items()}
    return {
        job: [other for other in others if other in own and asked[other] != asked[job]]
        for job, others in neighbours(settings).items()
        if job in own
    }


def neighbours(settings: Mapping[int, Settings]) -> dict[int, list[int]]:
    """Give for each job those that differ from it in one key, by values next to each other.

    Numbers are next to each other by their size, words by the order in which the sweep first names them.
    """
    places = _places(settings)
    at = {place: job for job, place in places.items()}
    return {
        job: [
            at[beside]
            for axis in range(len(place))
            for step in (-1, 1)
            if (beside := (*place[:axis], place[axis] + step, *place[axis + 1 :])) in at
        ]
        for job, place in places.items()
    }


def _places(settings: Mapping[int, Settings]) -> dict[int, tuple[int, ...]]:
    """Give for each job the ranks of its values."""
    rows = {job: [value for _, value in settings[job]] for job in sorted(settings)}
    ranks = [
        {value: rank for rank, value in enumerate(in_order(column))} for column in zip(*rows.values(), strict=True)
    ]
    return {job: tuple(rank[value] for rank, value in zip(ranks, row, strict=True)) for job, row in rows.items()}


def why_worse(design: Design, others: Mapping[int, Design]) -> str:
    """Say why a design scores worse than that of a neighbour with fewer of its lenses; nothing where it does not.

    Args:
        design: of a job, once all agree.
        others: of its neighbours, by their numbers.
    """
    better = [job for job, other in others.items() if _is_fewer(other, design) and _is_better(other, design)]
    if not better:
        return ""
    best = min(better, key=lambda job: others[job].score)
    problem, layouts = design.problem, carried_over(design.problem, others[best])
    if not layouts:
        reason = "beside its lenses there is no room for another body"
    elif not any(
        certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap).feasible for layout in layouts
    ):
        reason = "another body takes room that its lenses need"
    else:
        reason = "a lens added to it makes the score worse"
    return f"worse than job {best} with fewer lenses: {reason}"


def _better_by(design: Design, others: Sequence[Design]) -> Design | None:
    """Give a better design that a search from what others have come to leads to, None where it leads to none."""
    carried = [layout for other in others for layout in carried_over(design.problem, other)]
    if not carried:
        return None
    found = solve(design.problem, starts=0, patience=0, proof=0, known=[design.layout, *carried])
    if not _is_better(found, design):
        return None
    # The bound is the problem's, and its own search's history stays its own.
    origin = None if design.origin is None else replace(design.origin, known=len(carried))
    return replace(design, layout=found.layout, certificate=found.certificate, origin=origin)


def _is_better(one: Design, other: Design) -> bool:
    return one.score < other.score - PROGRESS * abs(other.score)


def _is_fewer(one: Design, other: Design) -> bool:
    """Whether a design has some of the other's lenses and no more, and was asked the same of them."""
    few, many = Counter(one.problem.lenses), Counter(other.problem.lenses)
    return few < many and _as_text(one.problem, lenses=False) == _as_text(other.problem, lenses=False)


def _as_text(question: Question, lenses: bool = True) -> str:
    """Give all that is asked as text, with the lenses that it is asked of or without."""
    try:
        asked = problem_record(question)
        # A name makes no lens unlike another.
        alike = [lens | {"name": None} for lens in asked["lenses"]]
        return json.dumps(asked | {"lenses": alike if lenses else None})
    except TypeError:
        # A score or a cue of one's own is like no other.
        return str(id(question))
