"""Everything on the line "length used = L", where the optimum lies: exhaustive search, switching ratio, and the slow slide.

On the line one number is left beside the focus: the gap b, with 2 A = ROOM - b. Errors are in units of 1 / f_dfdd, so that only
the ratio f_stereo / f_dfdd remains. Lengths in millimetres.
"""

from collections.abc import Callable
from dataclasses import dataclass

import torch
from jaxtyping import Float
from torch import Tensor

from multilens.optics.defocus import focused_sensitivity
from multilens.optics.stereo import stereo_sensitivity

ROOM, LONGEST = 48.0, 46.0
"""Gap and aperture share L - 2 r; the gap alone is at most L - 4 r."""

EXTREMES = torch.tensor([0.0, LONGEST], dtype=torch.float64)

AT_ONCE = 100_000
"""Numbers computed together: few enough to stay in the processor's cache."""

ONE = torch.tensor(1.0, dtype=torch.float64)


@dataclass(frozen=True)
class Profile:
    """The least loss for each gap, and the focus that gives it.

    Args:
        gap: b, mm.
        loss: mean squared error, in units of 1 / f_dfdd^2.
        focus: Zf, mm.
    """

    gap: Float[Tensor, "*b"]
    loss: Float[Tensor, "*b"]
    focus: Float[Tensor, "*b"]


def rim_to_rim(gap: Tensor) -> Tensor:
    """The thesis' baseline: the gap itself."""
    return gap


def centre_to_centre(gap: Tensor) -> Tensor:
    """The baseline of the field: the gap and both radii, b + r + A = b + 1 + (ROOM - b)/2."""
    return gap + 1 + (ROOM - gap) / 2


Baseline = Callable[[Tensor], Tensor]
"""From gap to baseline, mm, for the two lenses on the line."""


def errors(
    gap: Float[Tensor, "*batch"],
    focus: Float[Tensor, "*batch"],
    depths: Float[Tensor, " z"],
    ratio: float | Tensor,
    baseline: Baseline = rim_to_rim,
) -> tuple[Float[Tensor, "*batch z"], Float[Tensor, "*batch z"]]:
    """Give the errors of stereo and of defocus at each depth."""
    long = baseline(gap).clamp(min=1e-6).unsqueeze(-1)
    stereo = stereo_sensitivity(depths, long, torch.as_tensor(ratio, dtype=torch.float64))
    return stereo, focused_sensitivity(depths, ((ROOM - gap) / 2).unsqueeze(-1), ONE, focus.unsqueeze(-1))


def least_loss(
    gap: Float[Tensor, " b"],
    depths: Float[Tensor, " z"],
    ratio: float,
    foci: int = 161,
    baseline: Baseline = rim_to_rim,
) -> Profile:
    """Try every focus of a grid at every gap, then polish the best focus of each gap.

    For given winners the loss is a parabola in Zf with its foot at sum Z^3 / sum Z^2 over the depths that defocus wins: the
    polish goes to the foot and names the winners again until nothing improves.
    """

    def loss_at(focus: Tensor) -> Tensor:
        return torch.minimum(*errors(gap, focus, depths, ratio, baseline)).square().mean(-1)

    best, focus = torch.full_like(gap, torch.inf), torch.zeros_like(gap)
    grid = torch.linspace(depths.min().item(), depths.max().item(), foci, dtype=torch.float64)
    for tried in grid.split(max(1, AT_ONCE // (len(gap) * len(depths)))):
        found, at = loss_at(tried.unsqueeze(-1).expand(-1, len(gap))).min(0)
        focus, best = torch.where(found < best, tried[at], focus), torch.minimum(found, best)
    for _ in range(50):
        stereo, defocus = errors(gap, focus, depths, ratio, baseline)
        weight = (defocus < stereo) * depths**2
        foot = (weight * depths).sum(-1) / weight.sum(-1)
        found = loss_at(foot.nan_to_num(depths.min().item()))
        better = found < best
        if not better.any():
            break
        focus, best = torch.where(better, foot, focus), torch.where(better, found, best)
    return Profile(gap, best, focus)


def polished_optimum(depths: Float[Tensor, " z"], ratio: float, baseline: Baseline = rim_to_rim) -> Profile:
    """Give the best of every 0.25 mm of gap; at the two extremes the focus is looked for on a grid of 4001.

    A pinhole's defocus beats stereo in a band of a few tenths of a millimetre about its focus, so that the best focus at b =
    46 has a rival next to every depth that is sampled.
    """
    inner = least_loss(torch.linspace(0, LONGEST, 185, dtype=torch.float64), depths, ratio, baseline=baseline)
    outer = least_loss(EXTREMES, depths, ratio, 4001, baseline)
    every = [torch.cat(pair) for pair in ((inner.gap, outer.gap), (inner.loss, outer.loss), (inner.focus, outer.focus))]
    best = every[1].argmin()
    return Profile(*(column[best] for column in every))


def switching_ratio(depths: Float[Tensor, " z"], baseline: Baseline = rim_to_rim) -> float:
    """Give the f_stereo / f_dfdd above which b = 46 beats b = 0, by bisection between 1 and 30."""
    low, high = 1.0, 30.0
    while high - low > 1e-4:
        middle = (low + high) / 2
        defocus, stereo = least_loss(EXTREMES, depths, middle, baseline=baseline).loss
        low, high = (low, middle) if stereo < defocus else (middle, high)
    return (low + high) / 2


def slide(
    gap: Float[Tensor, "*batch"],
    focus: Float[Tensor, "*batch"],
    depths: Float[Tensor, "*batch z"],
    ratio: Float[Tensor, "*batch"],
    moves: int,
) -> tuple[Float[Tensor, "m ..."], Float[Tensor, "m ..."], Float[Tensor, "m ..."]]:
    """Follow gradient descent of vanishing step along the line; give time, gap and focus after every move.

    The penalty's two slopes hold b + 2 A at ROOM and leave b' = -k (dJ/db - dJ/dD), with D = 2 A and k = 46^2 48^2 / (46^2 +
    48^2) from theta's own units, and Zf' = -(Zmax - Zmin)^2 dJ/dZf. Time counts iterations times step, over f_dfdd^2. Each
    problem takes its own time steps: at most 0.1 mm of gap and 1 % of the range of focus a move.
    """
    near, far = depths.amin(-1), depths.amax(-1)
    share = LONGEST**2 * ROOM**2 / (LONGEST**2 + ROOM**2)
    time, kept = torch.zeros_like(gap), []
    for _ in range(moves):
        kept.append((time, gap, focus))
        stereo, defocus = errors(gap, focus, depths, ratio.unsqueeze(-1))
        wins = defocus < stereo
        by_stereo = torch.where(wins, 0.0, stereo**2).mean(-1)
        by_defocus = torch.where(wins, defocus**2, 0.0).mean(-1)
        gap_speed = 2 * share * (by_stereo / gap.clamp(min=1e-6) - by_defocus / (ROOM - gap))
        slope = torch.where(wins, defocus * depths * (depths - focus.unsqueeze(-1)).sign(), 0.0).mean(-1)
        focus_speed = (far - near) ** 2 * 2 * slope / (ROOM - gap)
        tick = torch.minimum(
            0.1 / gap_speed.abs().clamp(min=1e-12), 0.01 * (far - near) / focus_speed.abs().clamp(min=1e-12)
        )
        time = time + tick
        gap = (gap + tick * gap_speed).clamp(0, LONGEST)
        focus = (focus + tick * focus_speed).maximum(near).minimum(far)
    times, gaps, foci = (torch.stack(column) for column in zip(*kept, strict=True))
    return times, gaps, foci
