"""What the design of a neighbouring question gives to begin with: its layout, if need be with a lens added or left out."""

from bisect import bisect
from collections.abc import Iterator, Sequence
from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.back import Back
from multilens.constraints import body_radius, room_at
from multilens.design import Design
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.question import Question
from multilens.search.starts import tried_places

MOST_PLACES = 12
"""For a lens that is added; the search moves it from there."""


def carried_over(problem: Question, design: Design) -> tuple[Layout, ...]:
    """Give layouts to begin with from a design of a neighbouring problem, for the `known` of `solve`.

    Of as many lenses it is the design's own layout; of more, the same with those added at their smallest apertures, in several
    places; of one less, the same without each lens in turn. Where the outlines differ in extent, all of these come a second time
    stretched from one to the other. They may break constraints of the problem.

    Args:
        problem: what is asked.
        design: of another problem, found or given.

    Returns:
        One layout each; none where there is no room for a lens to add, where the problem has fewer lenses by more than one, or
        where lenses have other numbers of tiers.
    """
    less = design.layout.count - len(problem.lenses)
    make = _more if less < 0 else _the_same if less == 0 else _one_less
    if less > 1:
        return ()
    tiers = max(lens.tiers for lens in problem.lenses)
    return tuple(
        Layout(layout.position, layout.aperture_radius, layout.focus[:, :tiers])
        for base in _on(problem.back, design)
        for layout in make(problem, design.problem.lenses, base)
    )


def _on(back: Back, design: Design) -> Iterator[Layout]:
    """Give the layout as it is, and stretched with the bounding box of the outline."""
    layout = design.layout
    yield layout
    bounds = [each.outline.bounds for each in (back, design.problem.back)]
    ours, theirs = torch.tensor(bounds, dtype=torch.float64).view(2, 2, 2)
    if not ours.equal(theirs):
        share = (layout.position - theirs[0]) / (theirs[1] - theirs[0])
        yield Layout(ours[0] + share * (ours[1] - ours[0]), layout.aperture_radius, layout.focus)


def _the_same(problem: Question, theirs: Sequence[Lens], layout: Layout) -> Iterator[Layout]:
    if _tiers(problem.lenses) == _tiers(theirs):
        yield layout


def _one_less(problem: Question, theirs: Sequence[Lens], layout: Layout) -> Iterator[Layout]:
    for index in range(len(theirs)):
        rest = [other for other in range(len(theirs)) if other != index]
        if _tiers(problem.lenses) == _tiers([theirs[other] for other in rest]):
            yield layout.only(rest)


def _more(problem: Question, theirs: Sequence[Lens], layout: Layout) -> Iterator[Layout]:
    lenses = problem.lenses
    standing = _partners(theirs, lenses) or _partners(_tiers(theirs), _tiers(lenses))
    if not standing:
        return
    # A lens of fewer tiers than others repeats its first focus.
    tiers = max(lens.tiers for lens in lenses)
    wide = torch.cat([layout.focus, layout.focus[:, :1].expand(-1, tiers - layout.focus.shape[1])], dim=1)
    grown = [Layout(layout.position, layout.aperture_radius, wide)]
    for index in sorted(set(range(len(lenses))) - set(standing)):
        others = [lenses[other] for other in standing]
        at = bisect(standing, index)
        # The first lens is tried in many places, and those after it in the roomiest that is left.
        places = MOST_PLACES if len(standing) == len(theirs) else 1
        grown = [
            _with(problem, index, at, place, each)
            for each in grown
            for place in _free_places(problem, lenses[index], others, each)[:places]
        ]
        standing.insert(at, index)
    yield from grown


def _partners(theirs: Sequence[Any], ours: Sequence[Any]) -> list[int]:
    """Give which of ours, in order, are theirs; none where not all of them are among ours."""
    found: list[int] = []
    for index, each in enumerate(ours):
        if len(found) < len(theirs) and each == theirs[len(found)]:
            found.append(index)
    return found if len(found) == len(theirs) else []


def _with(problem: Question, index: int, at: int, place: Float[Tensor, " 2"], layout: Layout) -> Layout:
    """Give a layout with one of the problem's lenses inserted, at its smallest aperture and a middling focus."""
    least, (near, far) = problem.lenses[index].aperture_radius[0], problem.focus_range[index]
    added = (place, layout.aperture_radius.new_tensor(least), torch.full_like(layout.focus[0], (near * far) ** 0.5))
    parts = (layout.position, layout.aperture_radius, layout.focus)
    return Layout(*(torch.cat([p[:at], one.unsqueeze(0), p[at:]]) for p, one in zip(parts, added, strict=True)))


def _free_places(problem: Question, lens: Lens, others: Sequence[Lens], layout: Layout) -> list[Tensor]:
    """Give places where the smallest body of a lens fits beside the others, as they are or else at their smallest apertures."""
    # A copy of its own: what is tried is remembered for whoever comes next.
    tried = tried_places(problem.back, seed=0)[0].clone()
    for axis, locked in enumerate(lens.position or (None, None)):
        if locked is not None:
            tried[:, axis] = locked
    on_back = torch.from_numpy(room_at(problem.back, tried[:, 0].numpy(), tried[:, 1].numpy()))
    distance = torch.cdist(tried, layout.position)
    least = [other.least_body_radius for other in others]
    for bodies in (body_radius(layout, others), torch.tensor(least, dtype=torch.float64)):
        room = torch.minimum(on_back, (distance - bodies - problem.gap).amin(-1)) - lens.least_body_radius
        if (room >= 0).any():
            return _far_apart(tried[room >= 0], room[room >= 0])
    return []


def _far_apart(places: Float[Tensor, "p 2"], room: Float[Tensor, " p"]) -> list[Tensor]:
    """Give a few places, the roomiest first, each the farthest from those before it."""
    chosen = [int(room.argmax())]
    distance = torch.full_like(room, torch.inf)
    while len(chosen) < min(MOST_PLACES, len(places)):
        distance = distance.minimum((places - places[chosen[-1]]).norm(dim=-1))
        chosen.append(int(distance.argmax()))
    return [places[index] for index in dict.fromkeys(chosen)]


def _tiers(lenses: Sequence[Lens]) -> list[int]:
    return [lens.tiers for lens in lenses]
