"""SciPy's SLSQP from random starts, with the gradients of objective and constraints written out: the peer to beat."""

from contextlib import suppress
from time import monotonic

import numpy as np
from jaxtyping import Float
from scipy.optimize import minimize

from benchmark.found import Found, Notebook, OverError, Task
from benchmark.peers.model import MARGIN, Model

ROUGH, FINE = 1e-7, 1e-11
"""Change of the logarithm of the score at which a run ends; the best is then run on to the fine one."""

MOST_ITERATIONS = 300

STARTS_AT_ONCE = 16


class Slsqp:
    """A problem as SLSQP asks for it: the logarithm of the score and the room left, each with its gradient.

    Args:
        problem: see `Model`.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        self.focus_slope = 2 * model.defocus_shape
        self.bounds = [(0.0, high) for high in model.upper]
        self.every = np.arange(len(model.z))
        self.tolerance = ROUGH
        self._at, self._room = b"", (np.empty(0), np.empty((0, 0)))

    def objective(self, v: Float[np.ndarray, " d"]) -> tuple[float, Float[np.ndarray, " d"]]:
        """Give the logarithm of the score and its gradient; of all pairs only that of the least error is looked at."""
        model, n = self.model, self.model.n
        position, radius, focus = model.split(v)
        away = position[model.first] - position[model.second]
        baseline = np.maximum(np.sqrt(np.einsum("px,px->p", away, away)), 1e-6)
        gains = model.pair_noise / baseline
        pair = int(gains.argmin())
        miss = model.z - focus[:, None]
        curvature = (model.blur / radius) ** 2
        errors = np.empty((n + 1, len(model.z)))
        np.multiply(miss, miss, out=errors[:n])
        errors[:n] *= curvature[:, None]
        errors[:n] *= model.defocus_shape
        np.multiply(model.stereo_shape, gains[pair] ** 2, out=errors[n])
        winner = errors.argmin(0)
        best = errors[winner, self.every]
        won = np.bincount(winner, best, n + 1)
        score = won.sum()
        lens = np.minimum(winner, n - 1)
        slope = np.bincount(winner, self.focus_slope * miss[lens, self.every], n + 1)[:n] * -curvature
        gradient = np.zeros_like(v)
        place = gradient[: 2 * n].reshape(n, 2)
        pull = away[pair] * (-2 * won[n] / baseline[pair] ** 2) * model.size
        place[model.first[pair]] += pull
        place[model.second[pair]] -= pull
        gradient[2 * n : 3 * n] = -2 * won[:n] / radius * model.radius_span
        gradient[3 * n :] = slope * focus * model.log_focus_span
        return float(np.log(score)), gradient / score

    def room(self, v: Float[np.ndarray, " d"]) -> Float[np.ndarray, " c"]:
        """Give the room beyond the margin at the tightest limits and every pair, in units of the back's size; >= 0 is feasible."""
        return self._rooms(v)[0]

    def room_gradient(self, v: Float[np.ndarray, " d"]) -> Float[np.ndarray, "c d"]:
        """Give the gradient of the room."""
        return self._rooms(v)[1]

    def _rooms(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        # SciPy asks for value and gradient one after the other: each point is computed once.
        if v.tobytes() != self._at:
            self._room, self._at = self._rooms_at(v), v.tobytes()
        return self._room

    def _rooms_at(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        model, n = self.model, self.model.n
        position, radius, _ = model.split(v)
        body = radius + model.clearance
        walls, inward = model.walls(position)
        limits = walls.shape[1]
        first, second = model.first, model.second
        away = position[first] - position[second]
        apart = np.sqrt(np.einsum("px,px->p", away, away))
        between = apart - body[first] - body[second] - model.gap
        direction = away / np.maximum(apart, 1e-12)[:, None]
        rows = np.zeros((n * limits + len(between), len(v)))
        of_lens = rows[: n * limits].reshape(n, limits, -1)
        lens = np.arange(n)
        for axis in (0, 1):
            of_lens[lens, :, 2 * lens + axis] = inward[..., axis] * model.size[axis]
        of_lens[lens, :, 2 * n + lens] = -model.radius_span[:, None]
        pair = n * limits + np.arange(len(between))
        for axis in (0, 1):
            rows[pair, 2 * first + axis] = direction[:, axis] * model.size[axis]
            rows[pair, 2 * second + axis] = -direction[:, axis] * model.size[axis]
        rows[pair, 2 * n + first] = -model.radius_span[first]
        rows[pair, 2 * n + second] = -model.radius_span[second]
        room = np.concatenate([(walls - body[:, None]).ravel(), between])
        scale = model.size.max()
        # SLSQP is content with constraints that lack as much as its tolerance, all together.
        return (room - MARGIN) / scale - self.tolerance, rows / scale

    def run(
        self, start: Float[np.ndarray, " d"], tolerance: float = ROUGH, notebook: Notebook | None = None
    ) -> Float[np.ndarray, " d"]:
        """Give where SLSQP ends from a start.

        Args:
            start: feasible or not.
            tolerance: of the logarithm of the score, and of the room as a part of the back's size.
            notebook: whose clock ends the run.

        Raises:
            OverError: the run must end.
        """

        def objective(v: np.ndarray) -> tuple[float, np.ndarray]:
            if notebook is not None:
                notebook.refuse_after_the_end()
            return self.objective(v)

        self.tolerance, self._at = tolerance, b""
        end = minimize(
            objective,
            start,
            jac=True,
            bounds=self.bounds,
            constraints={"type": "ineq", "fun": self.room, "jac": self.room_gradient},
            method="SLSQP",
            options={"maxiter": MOST_ITERATIONS, "ftol": self.tolerance},
        )
        return end.x


def slsqp(task: Task) -> list[Found]:
    """Run from one random start after the other until the clock stops; what is better than all before is run to the end."""
    notebook = Notebook(task, monotonic)
    model = Model(task.problem)
    solver, random = Slsqp(model), np.random.default_rng(task.seed)

    def tell(end: Float[np.ndarray, " d"]) -> bool:
        if not np.isfinite(end).all():
            return False
        # What lacks no more than the margin is feasible once the radii have given way by as much.
        settled, missing = model.settle(end[None])
        score = model.score(settled)[0]
        if missing[0] >= MARGIN or score >= notebook.best:
            return False
        notebook.tell(score, lambda: model.layout(settled[0]))
        return True

    with suppress(OverError):
        while not notebook.over:
            for start in model.random_starts(random, STARTS_AT_ONCE):
                end = solver.run(start, ROUGH, notebook)
                if tell(end):
                    tell(solver.run(end, FINE, notebook))
    return notebook.all()
