"""A problem with the thesis' two cues as plain NumPy: its unknowns as a vector, its objective and its room, many at a time.

It is what an engineer would write for one study, and shares nothing with the library's search. A test holds it against the
library's score and certificate.
"""

import numpy as np
from jaxtyping import Float

import multilens as ml
from benchmark.peers.walls import Walls

MARGIN = 2e-8
"""mm; room that is kept beyond what is asked, so that what is feasible up to rounding is so for the exact referee too."""


class Model:
    """The unknowns, from 0 to 1 each: x and y of every lens over the bounding box, radii over their bounds, log foci over theirs.

    Args:
        problem: lenses of one focus each that may stand anywhere, cues PairStereo and LensDefocus.
    """

    def __init__(self, problem: ml.Problem) -> None:
        lenses = problem.lenses
        if any(lens.tiers != 1 or lens.position is not None for lens in lenses):
            raise ValueError("lenses must be free and have one focus each for this peer")
        self.problem, self.n, self.gap = problem, len(lenses), problem.gap
        self.z, self.weights = problem.depths.numpy(), problem.weights.numpy()
        self.first, self.second = np.triu_indices(self.n, 1)
        angular = np.array([lens.disparity_noise / lens.focal_length for lens in lenses])
        self.pair_noise = np.sqrt((angular[self.first] ** 2 + angular[self.second] ** 2) / 2)
        self.blur = np.array([lens.blur_noise / (2 * lens.focal_length) for lens in lenses])
        self.clearance = np.array([lens.clearance for lens in lenses])
        left, top, right, bottom = problem.back.outline.bounds
        self.corner, self.size = np.array([left, top]), np.array([right - left, bottom - top])
        radius = np.array([lens.aperture_radius for lens in lenses], dtype=float)
        self.radius_low, self.radius_high = radius.T
        log_focus = np.log(np.array(problem.focus_range, dtype=float))
        self.log_focus_low, self.log_focus_high = log_focus.T
        # What cannot change has no range: its bounds are 0 and 0.
        self.radius_span = self.radius_high - self.radius_low
        self.log_focus_span = self.log_focus_high - self.log_focus_low
        self.upper = np.concatenate([np.ones(2 * self.n), self.radius_span > 0, self.log_focus_span > 0])
        self.walls = Walls(problem.back)
        # (Z^2)^2 weighted, for stereo, and Z^2 weighted, for defocus: what is the same for every layout.
        self.stereo_shape = self.weights * self.z**4
        self.defocus_shape = self.weights * self.z**2

    def split(self, v: Float[np.ndarray, "*b d"]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Give positions [*b, n, 2], radii [*b, n] and foci [*b, n], mm."""
        n = self.n
        position = v[..., : 2 * n].reshape(*v.shape[:-1], n, 2) * self.size + self.corner
        radius = v[..., 2 * n : 3 * n] * self.radius_span + self.radius_low
        return position, radius, np.exp(v[..., 3 * n :] * self.log_focus_span + self.log_focus_low)

    def join(self, position: np.ndarray, radius: np.ndarray, focus: np.ndarray) -> Float[np.ndarray, "*b d"]:
        """Give the vector of positions, radii and foci, mm."""
        place = ((position - self.corner) / self.size).reshape(*position.shape[:-2], 2 * self.n)
        wide = (radius - self.radius_low) / np.where(self.radius_span > 0, self.radius_span, 1)
        deep = (np.log(focus) - self.log_focus_low) / np.where(self.log_focus_span > 0, self.log_focus_span, 1)
        return np.concatenate([place, wide, deep], axis=-1)

    def layout(self, v: Float[np.ndarray, " d"]) -> ml.Layout:
        """Give a vector as the library's layout, for the common referee."""
        position, radius, focus = self.split(v)
        return ml.Layout(position.tolist(), radius.tolist(), focus.tolist())

    def score(self, v: Float[np.ndarray, "b d"]) -> Float[np.ndarray, " b"]:
        """Give the mean squared error of each vector, mm^2."""
        position, radius, focus = self.split(v)
        away = position[:, self.first] - position[:, self.second]
        gain = (self.pair_noise / np.maximum(np.sqrt((away**2).sum(-1)), 1e-6)).min(1)
        least = (gain**2)[:, None] * self.stereo_shape
        for k in range(self.n):
            one = self.z - focus[:, k : k + 1]
            one *= one
            one *= ((self.blur[k] / radius[:, k]) ** 2)[:, None] * self.defocus_shape
            np.minimum(least, one, out=least)
        return least.sum(1)

    def settle(self, v: Float[np.ndarray, "b d"]) -> tuple[Float[np.ndarray, "b d"], Float[np.ndarray, " b"]]:
        """Let radii give way where room is missing, as far as their bounds allow; give the vectors and what is still lacking."""
        position, radius, _ = self.split(v)
        away = position[:, self.first] - position[:, self.second]
        apart = np.sqrt((away**2).sum(-1)) - self.gap - MARGIN
        walls = self.walls(position.reshape(-1, 2))[0].min(1).reshape(radius.shape) - MARGIN
        body = np.minimum(radius + self.clearance, walls)
        too_much = np.maximum(body[:, self.first] + body[:, self.second] - apart, 0) / 2
        lack = np.zeros_like(body)
        for p, (i, j) in enumerate(zip(self.first, self.second, strict=True)):
            lack[:, i] = np.maximum(lack[:, i], too_much[:, p])
            lack[:, j] = np.maximum(lack[:, j], too_much[:, p])
        radius = np.minimum(np.maximum(body - lack - self.clearance, self.radius_low), self.radius_high)
        body = radius + self.clearance
        missing = np.maximum(body - walls, 0).sum(1)
        missing += np.maximum(body[:, self.first] + body[:, self.second] - apart, 0).sum(1)
        settled = v.copy()
        span = np.where(self.radius_span > 0, self.radius_span, 1)
        settled[:, 2 * self.n : 3 * self.n] = (radius - self.radius_low) / span
        return settled, missing

    def random_starts(self, random: np.random.Generator, count: int) -> Float[np.ndarray, "count d"]:
        """Give vectors spread evenly, every lens where its smallest body fits by itself, and clear of the others if it can be."""
        v = random.uniform(size=(count, len(self.upper))) * self.upper
        smallest = self.radius_low + self.clearance
        for each in v:
            places = self._places(random)
            room = self.walls(places)[0].min(1)
            for i in range(self.n):
                fits = np.flatnonzero(room >= smallest[i])
                if not len(fits):
                    continue
                clear = np.ones(len(fits), dtype=bool)
                for j in range(i):
                    taken = each[2 * j : 2 * j + 2] * self.size + self.corner
                    apart = smallest[i] + smallest[j] + self.gap
                    clear &= ((places[fits] - taken) ** 2).sum(1) >= apart**2
                chosen = fits[clear.argmax()] if clear.any() else fits[0]
                each[2 * i : 2 * i + 2] = (places[chosen] - self.corner) / self.size
        return v

    def _places(self, random: np.random.Generator) -> Float[np.ndarray, "m 2"]:
        return random.uniform(self.corner, self.corner + self.size, (24 * self.n, 2))
