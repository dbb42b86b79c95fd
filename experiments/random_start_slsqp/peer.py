"""The peer: SciPy's SLSQP from random starts, with objective, constraints and all gradients written out in NumPy.

It knows what is special about this problem, as a good engineer would write it for one study: equal lenses, a back with round
corners, discs and upright rectangles to stay clear of. Nothing of the library's search is used.
"""

import numpy as np
from scipy.optimize import minimize
from shapely import Point

import multilens as ml

MARGIN = 1e-7
"""mm; so that what SLSQP calls feasible up to its tolerance is feasible for the exact referee too."""


class Peer:
    """One problem in the peer's own terms.

    The unknowns are x and y of every lens in units of 100 mm, then their radii in mm, then the logarithms of their foci.

    Args:
        problem: equal lenses with one focus each, the two thesis cues, an outline with corners rounder than a lens' body.
    """

    def __init__(self, problem: ml.Problem) -> None:
        lens, outline = problem.lenses[0], problem.back.outline
        assert all(other == lens for other in problem.lenses)
        assert outline.radius > lens.aperture_radius[1] + lens.clearance
        self.problem, self.n = problem, len(problem.lenses)
        self.z, self.weights = problem.depths.numpy(), problem.weights.numpy()
        self.stereo_noise = lens.disparity_noise / lens.focal_length
        self.defocus_noise = lens.blur_noise / (2 * lens.focal_length)
        self.clearance, self.gap = lens.clearance, problem.gap
        self.first, self.second = np.triu_indices(self.n, 1)
        self.place = 100.0
        near, far = problem.focus_range[0]
        left, top, right, bottom = outline.bounds
        self.low = np.concatenate(
            [
                np.tile([left, top], self.n) / self.place,
                np.full(self.n, lens.aperture_radius[0]),
                np.full(self.n, np.log(near)),
            ]
        )
        self.high = np.concatenate(
            [
                np.tile([right, bottom], self.n) / self.place,
                np.full(self.n, lens.aperture_radius[1]),
                np.full(self.n, np.log(far)),
            ]
        )
        # Everything is a box grown by a radius: the outline to stay within, the keep-outs to stay clear of.
        self.outline = np.array(outline.core.bounds), outline.radius
        self.keep_outs = [(np.array(k.shape.core.bounds), k.shape.radius + k.clearance) for k in problem.back.keep_outs]
        for keep_out in problem.back.keep_outs:
            core = keep_out.shape.core
            assert isinstance(core, Point) or core.equals(core.envelope)

    def split(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Give positions [n, 2], mm, radii [n], mm, and foci [n], mm."""
        n = self.n
        return v[: 2 * n].reshape(n, 2) * self.place, v[2 * n : 3 * n], np.exp(v[3 * n :])

    def objective(self, v: np.ndarray) -> tuple[float, np.ndarray]:
        """Give the mean squared error and its gradient."""
        position, radius, focus = self.split(v)
        away = position[self.first] - position[self.second]
        baseline = np.maximum(np.linalg.norm(away, axis=1), 1e-9)
        widest = baseline.argmax()
        stereo = (self.z**2 * self.stereo_noise / baseline[widest]) ** 2
        miss = self.z - focus[:, None]
        defocus = (self.z * miss * (self.defocus_noise / radius)[:, None]) ** 2
        errors = np.vstack([stereo, defocus])
        winner = errors.argmin(0)
        best = errors[winner, np.arange(len(self.z))] * self.weights
        gradient = np.zeros_like(v)
        by_stereo = best[winner == 0].sum() * -2 / baseline[widest]
        direction = away[widest] / baseline[widest] * by_stereo * self.place
        i, j = self.first[widest], self.second[widest]
        gradient[2 * i : 2 * i + 2] += direction
        gradient[2 * j : 2 * j + 2] -= direction
        for k in range(self.n):
            mine = winner == k + 1
            gradient[2 * self.n + k] = best[mine].sum() * -2 / radius[k]
            slope = (self.z * self.defocus_noise / radius[k]) ** 2 * -2 * miss[k] * self.weights
            gradient[3 * self.n + k] = slope[mine].sum() * focus[k]
        return best.sum(), gradient

    def room(self, v: np.ndarray) -> np.ndarray:
        """Give the room left at every constraint beyond the margin that rounding takes, mm; all >= 0 is feasible."""
        return self._room(v)[0] - MARGIN

    def room_gradient(self, v: np.ndarray) -> np.ndarray:
        """Give the gradient of the room."""
        return self._room(v)[1]

    def _room(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        n = self.n
        position, radius, _ = self.split(v)
        body = radius + self.clearance
        rooms, rows = [], []
        away = position[self.first] - position[self.second]
        distance = np.maximum(np.linalg.norm(away, axis=1), 1e-9)
        for k, (i, j) in enumerate(zip(self.first, self.second, strict=True)):
            row = np.zeros_like(v)
            row[2 * i : 2 * i + 2] = away[k] / distance[k] * self.place
            row[2 * j : 2 * j + 2] = -row[2 * i : 2 * i + 2]
            row[2 * n + i] = row[2 * n + j] = -1
            rooms.append(distance[k] - body[i] - body[j] - self.gap)
            rows.append(row)
        for sign, (box, reach) in [(-1, self.outline), *((1, keep) for keep in self.keep_outs)]:
            for i in range(n):
                value, direction = _signed_distance(box, position[i])
                row = np.zeros_like(v)
                row[2 * i : 2 * i + 2] = sign * direction * self.place
                row[2 * n + i] = -1
                rooms.append(sign * (value - reach) - body[i])
                rows.append(row)
        return np.array(rooms), np.array(rows)

    def random_start(self, random: np.random.Generator) -> np.ndarray:
        """Give a start drawn evenly from the box of bounds, every lens moved until its smallest body fits by itself."""
        start = random.uniform(self.low, self.high)
        start[2 * self.n : 3 * self.n] = self.low[2 * self.n : 3 * self.n]
        on_the_back = slice(self.n * (self.n - 1) // 2, None)
        for i in range(self.n):
            lens = slice(2 * i, 2 * i + 2)
            while (self.room(start)[on_the_back].reshape(-1, self.n)[:, i] < 0).any():
                start[lens] = random.uniform(self.low[lens], self.high[lens])
        return start

    def run(self, start: np.ndarray) -> np.ndarray:
        """Give where SLSQP ends from a start."""
        # Scaled to about 1, so that the tolerance means the same for every problem.
        scale = self.objective(start)[0]

        def scaled(v: np.ndarray) -> tuple[float, np.ndarray]:
            value, gradient = self.objective(v)
            return value / scale, gradient / scale

        return minimize(
            scaled,
            start,
            jac=True,
            bounds=list(zip(self.low, self.high, strict=True)),
            constraints={"type": "ineq", "fun": self.room, "jac": self.room_gradient},
            method="SLSQP",
            options={"maxiter": 500, "ftol": 1e-12},
        ).x

    def layout(self, v: np.ndarray) -> ml.Layout:
        """Give a vector as the library's layout, for the common referee."""
        position, radius, focus = self.split(v)
        return ml.Layout(position.tolist(), radius.tolist(), focus.tolist())


def _signed_distance(box: np.ndarray, point: np.ndarray) -> tuple[float, np.ndarray]:
    """Give the distance to a box (negative inside) and its gradient."""
    nearest = point.clip(box[:2], box[2:])
    away = point - nearest
    distance = float(np.hypot(*away))
    if distance > 0:
        return distance, away / distance
    depths = np.concatenate([point - box[:2], box[2:] - point])
    side = depths.argmin()
    direction = np.zeros(2)
    direction[side % 2] = -1.0 if side < 2 else 1.0
    return -float(depths[side]), direction
