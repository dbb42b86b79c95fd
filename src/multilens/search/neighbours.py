"""What the design of a neighbouring question gives to begin with: its layout, if need be with a lens added or left out."""

from collections.abc import Iterator, Sequence

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

    Of as many lenses it is the design's own layout; of one more, the same with a lens of the smallest aperture added in several
    places; of one less, the same without each lens in turn. Where the outlines differ in extent, all of these come a second time
    stretched from one to the other. They may break constraints of the problem.

    Args:
        problem: what is asked.
        design: of another problem, found or given.

    Returns:
        One layout each; none where there is no room for a lens to add, where the numbers of lenses differ by more than one, or
        where a lens has another number of tiers.
    """
    more = len(problem.lenses) - design.layout.count
    make = {-1: _one_less, 0: _the_same, 1: _one_more}.get(more)
    if make is None:
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


def _one_more(problem: Question, theirs: Sequence[Lens], layout: Layout) -> Iterator[Layout]:
    for index in _added(problem.lenses, theirs):
        lens, (near, far) = problem.lenses[index], problem.focus_range[index]
        rest = (*problem.lenses[:index], *problem.lenses[index + 1 :])
        tiers = max(lens.tiers, layout.focus.shape[1])
        # A lens of fewer tiers than others repeats its first focus.
        wide = torch.cat([layout.focus, layout.focus[:, :1].expand(-1, tiers - layout.focus.shape[1])], dim=1)
        focus = torch.full((1, tiers), (near * far) ** 0.5, dtype=torch.float64)
        for place in _free_places(problem, lens, rest, layout):
            yield Layout(
                _inserted(layout.position, index, place.unsqueeze(0)),
                _inserted(layout.aperture_radius, index, torch.tensor(lens.aperture_radius[:1], dtype=torch.float64)),
                _inserted(wide, index, focus),
            )


def _added(lenses: Sequence[Lens], theirs: Sequence[Lens]) -> list[int]:
    """Give which lens may be the one that they lack: the last of each kind without which the others are theirs, or like them."""
    kinds = {lens: index for index, lens in enumerate(lenses)}.values()
    rests = {index: (*lenses[:index], *lenses[index + 1 :]) for index in kinds}
    same = [index for index, rest in rests.items() if rest == tuple(theirs)]
    return same or [index for index, rest in rests.items() if _tiers(rest) == _tiers(theirs)]


def _free_places(problem: Question, lens: Lens, others: Sequence[Lens], layout: Layout) -> list[Tensor]:
    """Give places where the smallest body of a lens fits beside the others, as they are or else at their smallest apertures."""
    tried, _ = tried_places(problem.back, seed=0)
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


def _inserted(numbers: Tensor, index: int, one: Tensor) -> Tensor:
    return torch.cat([numbers[:index], one, numbers[index:]])


def _tiers(lenses: Sequence[Lens]) -> list[int]:
    return [lens.tiers for lens in lenses]
