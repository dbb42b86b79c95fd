"""The polish: from nearly feasible to a local optimum on its constraints, by sequential quadratic programming."""

from collections.abc import Callable
from math import inf
from time import monotonic

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from multilens.question import Question
from multilens.search.alone import Alone
from multilens.search.variables import Variables

MARGIN = 1e-10
"""Room that a polished layout keeps beyond what is asked, in units of the back's diagonal: more than rounding takes."""

LEAST_SCORE = 1e-12
"""Part of the score at the start below which its logarithm is not taken."""

GENTLE, BOLD = 0.01, 0.1
"""Factor of what is minimised. SLSQP takes its curvature for 1 at first: with a small slope its first steps are short, and what
is nearly there already stays in its basin. A first polish has farther to go."""

ROUNDS = 8
"""In which terms that were not watched may be found to matter."""

ValueAndGradient = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


class OutOfTimeError(Exception):
    """The deadline passed in the middle of a polish."""


def polish(
    question: Question,
    variables: Variables,
    x: Float[Tensor, " d"],
    deadline: float = inf,
    tolerance: float = 1e-13,
    gapless: bool = False,
) -> Float[Tensor, " d"]:
    """Take one vector to the nearest local optimum of the exact score under the exact constraints.

    Where the score is the largest of several terms, one more unknown is minimised that is no less than any of them. Of very many
    only the largest are watched; where another has become the largest in the end, it is watched, too, and all is done again. The
    winner of a depth may change on the way: a minimum of smooth errors has only concave kinks, and no local optimum lies on one.

    Args:
        question: what is asked.
        variables: in float64.
        x: where to begin; may be infeasible.
        deadline: by the monotonic clock, s.
        tolerance: change of the score, as a part of it, at which to stop.
        gapless: whether depths count as a range without gaps where the score has a closed form: a first polish, which ripples
            do not hold.

    Returns:
        The polished vector, feasible up to rounding unless the constraints cannot be met from here.

    Raises:
        OutOfTimeError: the deadline passed.

    Reference:
        D. Kraft, A software package for sequential quadratic programming (1988), as SciPy's SLSQP.
    """
    if not len(x):
        return x
    alone = Alone(question, variables, gapless)
    for _ in range(ROUNDS):
        if not alone.watch(x.numpy()):
            break
        x = _polished(alone, x, deadline, tolerance, BOLD if gapless else GENTLE)
    return x


def _polished(
    alone: Alone, x: Float[Tensor, " d"], deadline: float, tolerance: float, pace: float
) -> Float[Tensor, " d"]:
    """Polish by the terms that are watched."""
    from scipy.optimize import minimize

    question, size = alone.question, alone.question.back.size
    first, _ = alone.terms(x.numpy())
    # A score of one's own may be negative.
    squared = question.metric is not None and first.max() > 0
    scale = max(float(np.abs(first).max()), float(np.finfo(float).tiny))

    def terms(vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if monotonic() > deadline:
            raise OutOfTimeError
        values, gradient = alone.terms(vector)
        values, gradient = values / scale, gradient / scale
        if squared:
            values, gradient = _flattened(np.maximum(values, LEAST_SCORE), gradient)
        return pace * values, pace * gradient

    def room(vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        values, gradient = alone.room(vector)
        return values / size - margin, gradient / size

    # SLSQP is content with constraints that lack as much as its tolerance.
    margin = max(MARGIN, 2 * tolerance)

    objective, constraint, more = _as_one_objective(terms, room, x.numpy())
    value, jacobian = _apart(constraint)
    result = minimize(
        objective,
        np.append(x.numpy(), more),
        jac=True,
        bounds=[(0.0, high) for high in alone.variables.upper.tolist()] + [(None, None)] * len(more),
        constraints={"type": "ineq", "fun": value, "jac": jacobian},
        method="SLSQP",
        options={"ftol": pace * tolerance, "maxiter": 300},
    )
    if not np.isfinite(result.x).all():
        return x
    return torch.from_numpy(result.x[: len(x)]).clamp(min=0).minimum(alone.variables.upper)


def _flattened(values: np.ndarray, gradient: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Give the logarithm of one squared error, so that a tolerance is a part of it; of many the roots.

    A root is nearly linear in a focus, and steep nowhere, also at depths that are nearly in focus.
    """
    if len(values) == 1:
        return np.log(values), gradient / values[:, None]
    root = np.sqrt(values)
    return root, gradient / (2 * root[:, None])


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
