"""Many layouts at once to local optima that keep their limits: a batched interior-point method with quasi-Newton steps."""

from collections.abc import Callable
from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from multilens.search.sight import Seer, Sight

LEAST_SLACK = 0.05
"""Units of room that a limit counts as having at first where less is left: overlapping lenses are parted from there."""

ALLOWED = 1e-3
"""By which the merit may grow in a step: the winner of a depth may change on the way, and the pressure falls."""

NEARLY = 1e-3
"""Units of room that may be missing from a layout that counts as feasible: apertures can give that, or the polish."""


@dataclass(frozen=True)
class BarrierSettings:
    """How a barrier goes from far to near.

    Args:
        steps: how many, >= 1.
        pressure: of the limits on the lenses, first and last, passed through by equal factors: the weight mu of
            -log(room) beside the logarithm of the score.
        reach: largest change of an unknown in a step, as a part of its range.
    """

    steps: int = 50
    pressure: tuple[float, float] = (0.1, 1e-7)
    reach: float = 0.25


@dataclass(frozen=True)
class Settled:
    """Where the layouts have come to.

    Args:
        share: vector of each, every unknown.
        value: what was minimised.
        missing: room that the worst limit lacks, in the seer's units; negative where all are kept.
        history: value at every step.
    """

    share: Float[Tensor, "b v"]
    value: Float[Tensor, " b"]
    missing: Float[Tensor, " b"]
    history: Float[Tensor, "b h"]

    @property
    def feasible(self) -> Bool[Tensor, " b"]:
        """Whether hardly any room is missing and the value is a number."""
        return (self.missing <= NEARLY) & self.value.isfinite()


@dataclass(frozen=True)
class _State:
    """What is seen, and slack and force at every limit: pairs, edges, and the lower and upper end of each unknown."""

    sight: Sight
    slack: Tensor
    force: Tensor
    hessian: Tensor
    reach: Tensor


def settle(
    seer: Seer,
    share: Float[Tensor, "b v"],
    settings: BarrierSettings,
    go_on: Callable[[], bool] = lambda: True,
    watch: Callable[[Sight], None] = lambda sight: None,
) -> Settled:
    """Take each of a batch of vectors to a local optimum of the score under the limits.

    For a falling pressure mu each step goes towards the minimum of value - mu sum log(slack) with slack = room, by Newton's
    method on the primal and dual unknowns; the Hessian of the Lagrangian is built up by damped BFGS, for each layout by
    itself. A step that does not lower value - mu sum log(slack) + nu sum abs(room - slack) is not taken, and the next is
    shorter. A layout may begin infeasible: its slacks begin positive and the room follows.

    Args:
        seer: looks at the question.
        share: where to begin; held a little within the bounds.
        settings: how to go.
        go_on: asked before every step; False ends it where it is.
        watch: told what is seen at the beginning and after every step.

    Reference:
        J. Nocedal and S. Wright, Numerical optimization (2006), chapters 18 and 19: damped BFGS and interior points.
    """
    upper = seer.upper
    share = torch.where(seer.free, share.maximum(0.02 * upper).minimum(0.98 * upper), share)
    seer.calibrate(share)
    first, last = settings.pressure
    sight = seer.look(share, first)
    slack = _room(seer, sight).clamp(min=LEAST_SLACK)
    identity = torch.eye(seer.size, dtype=share.dtype, device=share.device).expand(len(share), -1, -1)
    state = _State(sight, slack, first / slack, identity, share.new_full((len(share),), settings.reach))
    history = [sight.value]
    watch(sight)
    for step in range(settings.steps):
        if not go_on():
            break
        pressure = first * (last / first) ** (step / max(1, settings.steps - 1))
        state = _stepped(seer, state, pressure, settings.reach)
        history.append(state.sight.value)
        watch(state.sight)
    sight = state.sight
    return Settled(sight.share, sight.value, -sight.room.amin(-1), torch.stack(history, dim=-1))


def _stepped(seer: Seer, now: _State, pressure: float, reach: float) -> _State:
    sight, slack, force = now.sight, now.slack, now.force
    room, limits = _room(seer, sight), sight.room.shape[1]
    stiffness, missing = force / slack, room - slack
    lower, upper = stiffness[:, limits:].chunk(2, dim=1)
    matrix = now.hessian + seer.curvature(sight, stiffness[:, :limits]) + torch.diag_embed(lower + upper)
    step = _solve(seer, matrix, _gathered(seer, sight, pressure / slack - stiffness * missing) - sight.slope)
    slack_step = torch.cat([seer.along(sight, step), step, -step], dim=1) + missing
    force_step = pressure / slack - force - stiffness * slack_step

    keep = max(0.9, 1 - pressure)
    longest = step.abs().amax(-1).clamp(min=torch.finfo(step.dtype).tiny)
    length = torch.minimum(_longest(slack, slack_step, keep), now.reach / longest).clamp_(max=1)
    moved = length.unsqueeze(-1) * step
    seen = seer.look(sight.share + moved, pressure)
    new_room, new_slack = _room(seer, seen), slack + length.unsqueeze(-1) * slack_step
    # What room there is may as well be used: a slack that lags behind only slows the way.
    new_slack = torch.where(new_room > 0.1 * new_slack, new_room, new_slack)
    new_force = force + _longest(force, force_step, keep).clamp_(max=1).unsqueeze(-1) * force_step

    worth = 1 + 2 * force.amax(-1)
    before = sight.value - pressure * slack.log().sum(-1) + worth * missing.abs().sum(-1)
    after = seen.value - pressure * new_slack.log().sum(-1) + worth * (new_room - new_slack).abs().sum(-1)
    taken = (after <= before + ALLOWED) & seen.slope.isfinite().all(-1)
    # Also a step that is not taken tells of the curvature.
    pulls = new_force[:, :limits]
    bent = (seen.slope - seer.gather(seen, pulls)) - (sight.slope - seer.gather(sight, pulls))
    each = taken.unsqueeze(-1)
    slack = torch.where(each, new_slack, slack)
    ideal = pressure / slack
    return _State(
        seen.where(taken, sight),
        slack,
        # A force stays within a hundredth and a hundred times what the pressure asks of it.
        torch.where(each, new_force, force).maximum(ideal / 100).minimum(ideal * 100),
        _updated(now.hessian, moved, bent),
        torch.where(taken, (1.5 * now.reach).clamp(max=reach), length * longest / 4),
    )


def _room(seer: Seer, sight: Sight) -> Float[Tensor, "b l"]:
    """Give the room at every limit and at both ends of each unknown; of what is not free there is always 1."""
    lower, upper = sight.share.where(seer.free, 1), (seer.upper - sight.share).where(seer.free, 1)
    return torch.cat([sight.room, lower, upper], dim=1)


def _gathered(seer: Seer, sight: Sight, force: Float[Tensor, "b l"]) -> Float[Tensor, "b v"]:
    limits = sight.room.shape[1]
    lower, upper = force[:, limits:].chunk(2, dim=1)
    return seer.gather(sight, force[:, :limits]) + lower - upper


def _solve(seer: Seer, matrix: Tensor, towards: Tensor) -> Tensor:
    """Solve for the free unknowns; a matrix that is not positive definite is made so."""
    free = seer.free.to(matrix)
    matrix = matrix * free * free.unsqueeze(-1) + torch.diag(1 - free)
    factor, failed = torch.linalg.cholesky_ex(matrix)
    if failed.any():
        heavier = matrix.diagonal(dim1=-2, dim2=-1).abs().amax(-1) * (failed > 0)
        identity = torch.eye(len(free), dtype=matrix.dtype, device=matrix.device)
        factor = torch.linalg.cholesky_ex(matrix + heavier.view(-1, 1, 1) * identity)[0]
    step = torch.cholesky_solve(towards.unsqueeze(-1), factor).squeeze(-1)
    return torch.where(step.isfinite(), step, 0) * free


def _longest(positive: Tensor, step: Tensor, keep: float) -> Tensor:
    """Give how much of a step may be taken so that a positive number keeps a part of itself."""
    return torch.where(step < 0, -keep * positive / step, torch.inf).amin(-1)


def _updated(hessian: Tensor, moved: Tensor, bent: Tensor) -> Tensor:
    """Give Powell's damped BFGS update; layouts that did not move keep what they have."""
    along = (hessian @ moved.unsqueeze(-1)).squeeze(-1)
    now, new = (moved * along).sum(-1), (moved * bent).sum(-1)
    damping = torch.where(new < 0.2 * now, 0.8 * now / (now - new), 1).unsqueeze(-1)
    bent = damping * bent + (1 - damping) * along
    new = (moved * bent).sum(-1)
    good = (now > 1e-18) & (new > 1e-18) & bent.isfinite().all(-1)
    less = along.unsqueeze(-1) * along.unsqueeze(-2) / now.view(-1, 1, 1)
    more = bent.unsqueeze(-1) * bent.unsqueeze(-2) / new.view(-1, 1, 1)
    return torch.where(good.view(-1, 1, 1), hessian - less + more, hessian)
