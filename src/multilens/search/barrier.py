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
    """Slacks and forces: of the limits, and of the lower and upper end of each unknown."""

    sight: Sight
    slack: Tensor
    force: Tensor
    below: Tensor
    above: Tensor
    hessian: Tensor
    reach: Tensor


def settle(
    seer: Seer,
    share: Float[Tensor, "b v"],
    settings: BarrierSettings,
    go_on: Callable[[], bool] = lambda: True,
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

    Reference:
        J. Nocedal and S. Wright, Numerical optimization (2006), chapters 18 and 19: damped BFGS and interior points.
    """
    upper = seer.upper
    share = torch.where(seer.free, share.maximum(0.02 * upper).minimum(0.98 * upper), share)
    seer.calibrate(share)
    first, last = settings.pressure
    sight = seer.look(share, first)
    slack = sight.room.clamp(min=LEAST_SLACK)
    identity = torch.eye(seer.size, dtype=share.dtype, device=share.device)
    state = _State(
        sight,
        slack,
        first / slack,
        first / _to_lower(seer, share),
        first / _to_upper(seer, share),
        identity.expand(len(share), -1, -1),
        share.new_full((len(share),), settings.reach),
    )
    history = [sight.value]
    for step in range(settings.steps):
        if not go_on():
            break
        pressure = first * (last / first) ** (step / max(1, settings.steps - 1))
        state = _stepped(seer, state, pressure, settings.reach)
        history.append(state.sight.value)
    sight = state.sight
    return Settled(sight.share, sight.value, -sight.room.amin(-1), torch.stack(history, dim=-1))


def _stepped(seer: Seer, now: _State, pressure: float, reach: float) -> _State:
    sight, slack = now.sight, now.slack
    lower, upper = _to_lower(seer, sight.share), _to_upper(seer, sight.share)
    stiffness, missing = now.force / slack, sight.room - slack
    matrix = now.hessian + seer.curvature(sight, stiffness)
    matrix = matrix + torch.diag_embed(now.below / lower + now.above / upper)
    towards = seer.gather(sight, pressure / slack - stiffness * missing) - sight.slope
    towards = torch.where(seer.free, towards + pressure / lower - pressure / upper, 0)
    step = _solve(seer, matrix, towards)
    slack_step = seer.along(sight, step) + missing
    force_step = pressure / slack - now.force - stiffness * slack_step
    below_step = pressure / lower - now.below - now.below / lower * step
    above_step = pressure / upper - now.above + now.above / upper * step

    keep = max(0.9, 1 - pressure)
    longest = step.abs().amax(-1)
    length = (
        torch.stack(
            [
                _longest(slack, slack_step, keep),
                _longest(lower, step, keep),
                _longest(upper, -step, keep),
                now.reach / longest.clamp(min=torch.finfo(step.dtype).tiny),
            ]
        )
        .amin(0)
        .clamp(max=1)
    )
    dual_length = (
        torch.stack(
            [
                _longest(now.force, force_step, keep),
                _longest(now.below, below_step, keep),
                _longest(now.above, above_step, keep),
            ]
        )
        .amin(0)
        .clamp(max=1)
        .unsqueeze(-1)
    )
    moved = length.unsqueeze(-1) * step
    seen = seer.look(sight.share + moved, pressure)
    new_slack = slack + length.unsqueeze(-1) * slack_step
    # What room there is may as well be used: a slack that lags behind only slows the way.
    new_slack = torch.where(seen.room > 0.1 * new_slack, seen.room, new_slack)
    new_force = now.force + dual_length * force_step

    worth = 1 + 2 * now.force.amax(-1)
    before = _merit(seer, sight, slack, pressure, worth)
    after = _merit(seer, seen, new_slack, pressure, worth)
    taken = (after <= before + ALLOWED) & seen.slope.isfinite().all(-1)
    # Also a step that is not taken tells of the curvature.
    bent = (seen.slope - seer.gather(seen, new_force)) - (sight.slope - seer.gather(sight, new_force))
    hessian = _updated(now.hessian, moved, bent)
    each = taken.unsqueeze(-1)
    sight = seen.where(taken, sight)
    slack = torch.where(each, new_slack, slack)
    lower, upper = _to_lower(seer, sight.share), _to_upper(seer, sight.share)
    return _State(
        sight,
        slack,
        _near(torch.where(each, new_force, now.force), pressure / slack),
        _near(torch.where(each, now.below + dual_length * below_step, now.below), pressure / lower),
        _near(torch.where(each, now.above + dual_length * above_step, now.above), pressure / upper),
        hessian,
        torch.where(taken, (1.5 * now.reach).clamp(max=reach), length * longest / 4),
    )


def _to_lower(seer: Seer, share: Tensor) -> Tensor:
    return torch.where(seer.free, share, 1)


def _to_upper(seer: Seer, share: Tensor) -> Tensor:
    return torch.where(seer.free, seer.upper - share, 1)


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


def _merit(seer: Seer, sight: Sight, slack: Tensor, pressure: float, worth: Tensor) -> Tensor:
    ends = (_to_lower(seer, sight.share) * _to_upper(seer, sight.share)).log().sum(-1)
    apart = (sight.room - slack).abs().sum(-1)
    return sight.value - pressure * (slack.log().sum(-1) + ends) + worth * apart


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


def _near(force: Tensor, ideal: Tensor) -> Tensor:
    """Keep a force within a hundredth and a hundred times what the pressure asks of it."""
    return force.maximum(ideal / 100).minimum(ideal * 100)
