"""One layout at a time, in NumPy: score and limits with their gradients, as the polish asks for them some hundred times."""

import numpy as np
import torch
from jaxtyping import Float

from multilens.cues import NANOMETRE
from multilens.problem import Problem
from multilens.question import Question
from multilens.search.gapless import Gapless
from multilens.search.limits import Limits
from multilens.search.variables import Variables

MOST_EDGES_WATCHED = 12
"""Around each lens, those that leave it least: a disc rarely touches more than three, and all would slow every step."""

MOST_PAIRS_WATCHED = 4
"""Pairs for each lens, those with the least room: few of all pairs are ever close."""

MOST_TERMS_WATCHED = 96
"""Of several terms, those that are largest: of the errors at all depths only those at a few are the worst at a time."""

ValueAndGradient = tuple[Float[np.ndarray, " m"], Float[np.ndarray, "m d"]]


class Alone:
    """A question as functions of one vector.

    Args:
        question: what is asked.
        variables: in float64, on the processor.
        gapless: whether several depths count as a range without gaps, where the score has a closed form.
    """

    def __init__(self, question: Question, variables: Variables, gapless: bool = False) -> None:
        self.question, self.variables, self.n = question, variables, variables.count
        self.limits = Limits(question)
        self.free, self.stretch = variables.free.numpy(), variables.stretch.numpy()
        self.low, self.start = variables.low.numpy(), variables.focus_start
        self.columns = np.arange(self.n)
        self.watched = np.empty(0, dtype=int)
        self.terms = self._by_autograd
        if isinstance(question, Problem) and question.has_closed_form:
            self.terms = self._of_curves
            known = question.closed_form(torch.device("cpu"))
            self.noise = known.noise.numpy() if len(known.first) else np.empty(0)
            self.lens, self.tier = known.lens.numpy(), known.tier.numpy()
            self.slope_times_radius = known.slope_times_radius.numpy()
            self.focus_of = variables.tier_of.numpy()[self.lens, self.tier]
            self.depths = question.depths.numpy()
            self.weights = question.score_weights.numpy()
            self.second, self.every = self.weights * self.depths**2, np.arange(len(self.depths))
            several = (self.depths != self.depths[0]).any()
            self.least = Gapless(self.depths, self.weights) if gapless and several else self._over_depths

    def room(self, x: Float[np.ndarray, " d"]) -> ValueAndGradient:
        """Give the room left at the pairs and edges that are near, mm, and its gradient."""
        n, lens = self.n, self.columns
        position, radius, _ = self._parts(x)
        apart, parting, inside, inward = self.limits.at(position, radius)
        first, second = self.limits.first, self.limits.second
        if len(apart) > (watched := MOST_PAIRS_WATCHED * n):
            # In the order of pairs and edges, so that a limit keeps its place from one step to the next.
            near = np.sort(np.argpartition(apart, watched)[:watched])
            apart, parting, first, second = apart[near], parting[near], first[near], second[near]
        if inside.shape[1] > MOST_EDGES_WATCHED:
            near = np.sort(np.argpartition(inside, MOST_EDGES_WATCHED, axis=1)[:, :MOST_EDGES_WATCHED], axis=1)
            inside, inward = inside[lens[:, None], near], inward[lens[:, None], near]
        pair = np.arange(len(apart))
        between = np.zeros((len(apart), len(self.low)))
        at_edges = np.zeros((*inside.shape, len(self.low)))
        for axis in (0, 1):
            between[pair, 2 * first + axis] = parting[:, axis]
            between[pair, 2 * second + axis] = -parting[:, axis]
            at_edges[lens, :, 2 * lens + axis] = inward[..., axis]
        between[pair, 2 * n + first] = between[pair, 2 * n + second] = -1
        at_edges[lens, :, 2 * n + lens] = -1
        # Positions and radii are linear in x, and no limit sees the foci.
        gradient = np.concatenate([between, at_edges.reshape(-1, len(self.low))])
        return np.concatenate([apart, inside.ravel()]), (gradient * self.stretch)[:, self.free]

    def watch(self, x: Float[np.ndarray, " d"]) -> bool:
        """Look at the largest terms from here on, beside those so far; give whether the largest of all was not among these."""
        if self.terms == self._of_curves:
            first, self.watched = not len(self.watched), np.zeros(1, dtype=int)
            return first
        with torch.no_grad():
            every = self.question.terms(self.variables.layout(torch.from_numpy(x))).numpy()
        overlooked = every.max() > every[self.watched].max(initial=-np.inf)
        self.watched = np.union1d(self.watched, np.argsort(-every, kind="stable")[:MOST_TERMS_WATCHED])
        return bool(overlooked)

    def _by_autograd(self, x: Float[np.ndarray, " d"]) -> ValueAndGradient:
        """Give the terms of any question that are watched, and their gradients: one copy of x for each."""
        points = torch.from_numpy(np.tile(x, (len(self.watched), 1))).requires_grad_()
        each = self.question.terms(self.variables.layout(points))
        values = each.gather(-1, torch.from_numpy(self.watched).unsqueeze(-1)).squeeze(-1)
        (rows,) = torch.autograd.grad(values.sum(), points)
        return values.detach().numpy(), rows.numpy()

    def _of_curves(self, x: Float[np.ndarray, " d"]) -> ValueAndGradient:
        """Give the score of the thesis' cues and its gradient.

        Divided by the depth, defocus is a V, slope abs(Z - Zf), and stereo of the best pair is gain Z, a V with its tip at 0.
        """
        position, radius, foci = self._parts(x)
        gradient, n, first, second = np.zeros(len(self.low)), self.n, self.limits.first, self.limits.second
        defocus = self.slope_times_radius / radius[self.lens]
        slope, tip = defocus, foci[self.focus_of]
        if len(self.noise):
            away = position[first] - position[second]
            distance = np.maximum(np.sqrt((away**2).sum(-1)), NANOMETRE)
            best = (self.noise / distance).argmin()
            gain = self.noise[best] / distance[best]
            slope, tip = np.append(defocus, gain), np.append(tip, 0.0)
            value, by_slope, by_tip = self.least(slope, tip)
            pull = -by_slope[-1] * gain / distance[best] ** 2 * away[best]
            gradient[2 * first[best] : 2 * first[best] + 2] += pull
            gradient[2 * second[best] : 2 * second[best] + 2] -= pull
        else:
            value, by_slope, by_tip = self.least(slope, tip)
        count = len(defocus)
        gradient[2 * n : self.start] = np.bincount(self.lens, -by_slope[:count] * defocus, n) / radius
        gradient[self.start :] = np.bincount(self.focus_of, by_tip[:count], len(foci)) * foci
        return np.array([value]), (gradient * self.stretch)[None, self.free]

    def _over_depths(
        self, slope: Float[np.ndarray, " k"], tip: Float[np.ndarray, " k"]
    ) -> tuple[float, Float[np.ndarray, " k"], Float[np.ndarray, " k"]]:
        """Give the mean of the least of (slope Z abs(Z - tip))^2 by plain sums, and its derivatives in slope and tip."""
        miss = self.depths - tip[:, None]
        winner = (np.abs(miss) * slope[:, None]).argmin(0)
        missed = miss[winner, self.every]
        drift = np.bincount(winner, self.second * missed, len(slope))
        spread = np.bincount(winner, self.second * missed**2, len(slope))
        return float(slope**2 @ spread), 2 * slope * spread, -2 * slope**2 * drift

    def _parts(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Give positions [n, 2], radii [n] and foci, all of all lenses in a row, mm."""
        share = np.zeros(len(self.low))
        share[self.free] = x
        linear = self.low[: self.start] + share[: self.start] * self.stretch[: self.start]
        foci = self.low[self.start :] * np.exp(share[self.start :] * self.stretch[self.start :])
        return linear[: 2 * self.n].reshape(-1, 2), linear[2 * self.n :], foci
