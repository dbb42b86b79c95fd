"""The polish: from nearly feasible to a local optimum on its constraints, by sequential quadratic programming."""

from collections.abc import Callable
from math import inf
from time import monotonic

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from multilens.geometry.pairs import pair_indices
from multilens.problem import Question
from multilens.search.limits import Limits
from multilens.search.variables import Variables

MARGIN = 1e-10
"""Room that a polished layout keeps beyond what is asked, in units of the back's diagonal: more than rounding takes."""

MOST_EDGES_WATCHED = 12
"""Around each lens, those that leave it least: a disc rarely touches more than three, and all would slow every step."""

MOST_PAIRS_WATCHED = 4
"""Pairs for each lens, those with the least room: few of all pairs are ever close."""

ValueAndGradient = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


class OutOfTimeError(Exception):
    """The deadline passed in the middle of a polish."""


def polish(
    question: Question,
    variables: Variables,
    x: Float[Tensor, " d"],
    deadline: float = inf,
    tolerance: float = 1e-13,
) -> Float[Tensor, " d"]:
    """Take one vector to the nearest local optimum of the exact score under the exact constraints.

    Where the score is the largest of several terms, one more unknown is minimised that is no less than any of them. The winner
    of a depth may change on the way: a minimum of smooth errors has only concave kinks, and no local optimum lies on one.

    Args:
        question: what is asked.
        variables: in float64.
        x: where to begin; may be infeasible.
        deadline: by the monotonic clock, s.
        tolerance: change of the score, as a part of it, at which to stop.

    Returns:
        The polished vector, feasible up to rounding unless the constraints cannot be met from here.

    Raises:
        OutOfTimeError: the deadline passed.

    Reference:
        D. Kraft, A software package for sequential quadratic programming (1988), as SciPy's SLSQP.
    """
    from scipy.optimize import minimize

    if not len(x):
        return x
    size = question.back.size
    scale = question.terms(variables.layout(x)).abs().amax().clamp(min=torch.finfo(x.dtype).tiny)

    def terms(vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if monotonic() > deadline:
            raise OutOfTimeError
        point = torch.from_numpy(vector).requires_grad_()
        values = question.terms(variables.layout(point)) / scale
        rows = [torch.autograd.grad(value, point, retain_graph=True)[0] for value in values]
        return values.detach().numpy(), torch.stack(rows).numpy()

    def room(vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        values, gradient = limits(torch.from_numpy(vector))
        return values.numpy() / size - margin, gradient.numpy() / size

    # SLSQP is content with constraints that lack as much as its tolerance.
    margin = max(MARGIN, 2 * tolerance)

    limits = _Rows(question, variables)
    objective, constraint, more = _as_one_objective(terms, room, x.numpy())
    value, jacobian = _apart(constraint)
    result = minimize(
        objective,
        np.append(x.numpy(), more),
        jac=True,
        bounds=[(0.0, high) for high in variables.upper.tolist()] + [(None, None)] * len(more),
        constraints={"type": "ineq", "fun": value, "jac": jacobian},
        method="SLSQP",
        options={"ftol": tolerance, "maxiter": 300},
    )
    if not np.isfinite(result.x).all():
        return x
    return torch.from_numpy(result.x[: len(x)]).clamp(min=0).minimum(variables.upper)


class _Rows:
    """The limits as rows: room, and its gradient in the free unknowns, of those pairs and edges that are near."""

    def __init__(self, question: Question, variables: Variables) -> None:
        self.limits, self.variables = Limits(question), variables

    def __call__(self, x: Float[Tensor, " d"]) -> tuple[Float[Tensor, " m"], Float[Tensor, "m d"]]:
        layout = self.variables.layout(x)
        room, n = self.limits(layout), layout.count
        first, second = pair_indices(n)
        # In the order of pairs and edges, so that a limit keeps its place from one step to the next.
        near = room.apart.topk(min(len(first), MOST_PAIRS_WATCHED * n), largest=False).indices.sort().values
        first, second, parting, row = first[near], second[near], room.parting[near], torch.arange(len(near))
        apart = parting.new_zeros(len(near), len(self.variables.low))
        for axis in (0, 1):
            apart[row, 2 * first + axis] = parting[:, axis]
            apart[row, 2 * second + axis] = -parting[:, axis]
        apart[row, 2 * n + first] = apart[row, 2 * n + second] = -1
        watched = min(room.inside.shape[-1], MOST_EDGES_WATCHED)
        edge = room.inside.topk(watched, largest=False).indices.sort(-1).values
        inward = room.inward.gather(-2, edge.unsqueeze(-1).expand(-1, -1, 2))
        inside, lens = inward.new_zeros(n, watched, len(self.variables.low)), torch.arange(n)
        for axis in (0, 1):
            inside[lens, :, 2 * lens + axis] = inward[..., axis]
        inside[lens, :, 2 * n + lens] = -1
        # Positions and radii are linear in x, and no limit sees the foci.
        gradient = torch.cat([apart, inside.flatten(0, 1)])[:, self.variables.free] * self.variables.span
        return torch.cat([room.apart[near], room.inside.gather(-1, edge).flatten()]), gradient


def _as_one_objective(
    terms: ValueAndGradient, room: ValueAndGradient, x: np.ndarray
) -> tuple[ValueAndGradient, ValueAndGradient, np.ndarray]:
    """Give objective, constraints and the start of the unknowns added to x: none for one term, their bound for several."""
    values, _ = terms(x)
    if len(values) == 1:
        return lambda v: tuple(part[0] for part in terms(v)), room, np.empty(0)
    along_bound = np.append(np.zeros_like(x), 1.0)

    def constraint(v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        (values, gradients), (left, room_gradient) = terms(v[:-1]), room(v[:-1])
        below = np.column_stack([-gradients, np.ones(len(values))])
        return np.append(v[-1] - values, left), np.vstack([below, np.pad(room_gradient, ((0, 0), (0, 1)))])

    return lambda v: (v[-1], along_bound), constraint, values.max(keepdims=True)


def _apart(both: ValueAndGradient) -> tuple[Callable[[np.ndarray], np.ndarray], Callable[[np.ndarray], np.ndarray]]:
    """Give value and gradient as two functions, as SciPy asks for constraints, that compute each point once."""
    last: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}

    def ask(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if x.tobytes() not in last:
            last.clear()
            last[x.tobytes()] = both(x.copy())
        return last[x.tobytes()]

    return lambda x: ask(x)[0], lambda x: ask(x)[1]
