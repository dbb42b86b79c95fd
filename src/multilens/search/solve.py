"""Solve a question: begin from what is known and afresh, vary the best wave by wave, polish and prove the best of all."""

from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import pairwise
from math import inf, nan
from time import monotonic

import torch
from torch import Tensor

from multilens.bounds.bound import lower_bound
from multilens.design import COMPLETE, INFEASIBLE, OUT_OF_TIME, Design, Origin
from multilens.layout import Layout
from multilens.penalty import Price, distance_penalty
from multilens.question import Question
from multilens.search.barrier import BarrierSettings, Settled, settle
from multilens.search.first import first_layouts
from multilens.search.fit import why_nothing_fits
from multilens.search.foci import Foci
from multilens.search.legalise import legalise
from multilens.search.limits import Limits
from multilens.search.parting import part
from multilens.search.polish import OutOfTimeError, polish
from multilens.search.pool import Candidate, Elite
from multilens.search.progress import BOUND, Listener, Progress
from multilens.search.rough import at_few_depths
from multilens.search.sight import Seer
from multilens.search.starts import scattered_starts, tried_places
from multilens.search.tally import Tally
from multilens.search.threads import one_thread
from multilens.search.tighten import tighten
from multilens.search.variables import Variables
from multilens.search.variation import Varier
from multilens.storage import source_commit, versions

STEPS, STEPS_PER_LENS = 12, 6
"""Of the barrier; more lenses take longer to come to rest."""

FROM_AFAR, FROM_NEARBY = 2e-2, 3e-3
"""Pressure at which fresh starts and variations begin: the less, the more they keep of where they begin."""

LAST = 1e-6
"""Pressure at which they end."""

BATCH = 64
"""Layouts that settle together: as many as the processor takes hardly longer for than for one."""

LENSES_AT_FIRST = 192
"""Lenses of all the layouts that settle before the first answer."""

MOST_ELITE = 8
"""Layouts that are varied."""

WORTH_A_POLISH = 2e-3
"""By how much, in the logarithm of the score, a layout may be behind the best and yet be polished."""

ALIKE = 3e-5
"""Difference of that below which two layouts came to the same place, and one of them is polished."""

FIRST_ANSWER = 1.0
"""s; by which the first layouts may overrun a time limit: an answer a little late is better than none."""

PROGRESS = 1e-5
"""Part of the score that counts as progress: less is the polish's business."""

ROUGH = 1e-10
"""Part of the score to which a layout is polished during the search; the best is polished to the end."""


def solve(
    problem: Question,
    starts: int = 64,
    seed: int = 0,
    time_limit: float | None = None,
    patience: int = 12,
    proof: int = 4000,
    penalty: Callable[[Question], Price] = distance_penalty,
    batch: int = BATCH,
    device: str | torch.device = "cpu",
    dtype: torch.dtype = torch.float64,
    listener: Listener = lambda progress: None,
    known: Sequence[Layout] = (),
) -> Design:
    """Find the layout that answers a question best.

    Args:
        problem: what is asked.
        starts: how many fresh layouts to begin with, >= 1, or >= 0 where layouts are known.
        seed: of the starts and the variations; the same seed on the same machine gives the same design to the bit, unless
            time ran out.
        time_limit: after which the best so far is given, s; None waits to the end.
        patience: waves of variations without progress after which the search ends, >= 0.
        proof: boxes of apertures that the lower bound may look at once the search is over, >= 0; 0 seeks none. Time and time
            limit do not count it: a second or two.
        penalty: by what overlapping starts are parted: `distance_penalty` or `area_penalty`.
        batch: layouts computed together, >= 1: more need more memory, and make the most of a GPU.
        device: where the waves are computed; the polish and the proof run on the processor.
        dtype: in which the waves are computed; the polish is in float64.
        listener: told of the progress after every wave.
        known: layouts of these lenses to begin with besides, such as `carried_over` gives. One that is feasible is never better
            than the design that is found; one that is not is brought near.

    Returns:
        The best feasible design; or, with the status "infeasible" and a reason, the layout that came nearest to being so.

    Raises:
        ValueError: a number is out of its range.
        RuntimeError: no start stayed healthy: every one, known or fresh, met a score or a gradient that is not finite.
    """
    for name, number, least in (
        ("starts", starts, 0 if known else 1),
        ("patience", patience, 0),
        ("proof", proof, 0),
        ("batch", batch, 1),
    ):
        if number < least:
            raise ValueError(f"{name} must be >= {least}, got {number}")
    if time_limit is not None and not time_limit > 0:
        raise ValueError(f"time_limit must be > 0 s, got {time_limit:g}")
    _refuse_unless_of(problem, known)
    end = inf if time_limit is None else monotonic() + time_limit
    name = getattr(penalty, "__name__", repr(penalty))
    origin = Origin(seed, starts, patience, name, time_limit, versions(), source_commit(), len(known))
    if (reason := why_nothing_fits(problem)) is not None:
        variables = Variables(problem)
        layout, certificate = legalise(problem, variables.layout(scattered_starts(problem, variables, 1, seed)[0]))
        return Design(problem, layout, INFEASIBLE, reason, certificate, origin=origin)
    with one_thread():
        search = _Search(problem, Variables(problem, dtype, device), penalty, seed, end, listener)
        search.know(known, batch)
        if starts:
            search.choose()
            search.open(starts, batch)
        if not search.alive:
            begun = starts + len(known)
            raise RuntimeError(f"none of the {begun} starts stayed healthy: scores or gradients were not finite")
        search.vary(patience, batch)
        search.finish()
    best, convergence = search.best, search.tally.convergence
    if best.certificate.feasible:
        status = OUT_OF_TIME if search.out_of_time else COMPLETE
        if proof:
            search.tell(BOUND, 0.0, search.alive)
        bound = lower_bound(problem, proof, best.score) if proof else None
        return Design(problem, best.layout, status, "", best.certificate, convergence, origin, bound)
    tightest = best.certificate.tightest
    searched = f" in {time_limit:g} s" if search.out_of_time else ""
    reason = f"no feasible layout found{searched}: at best {tightest.what} lacks {-tightest.room:.4g} mm"
    return Design(problem, best.layout, INFEASIBLE, reason, best.certificate, convergence, origin)


def _refuse_unless_of(question: Question, known: Sequence[Layout]) -> None:
    lenses, tiers = len(question.lenses), max(lens.tiers for lens in question.lenses)
    for index, layout in enumerate(known):
        if layout.aperture_radius.shape != (lenses,) or layout.focus.shape[-1] < tiers:
            shape = list(layout.focus.shape)
            raise ValueError(f"known[{index}] must be one layout, its foci of shape {[lenses, tiers]}, got {shape}")


class _Search:
    """One search on its way: the best so far, and what the next wave begins from."""

    def __init__(
        self,
        question: Question,
        variables: Variables,
        penalty: Callable[[Question], Price],
        seed: int,
        end: float,
        listener: Listener,
    ) -> None:
        self.question, self.variables, self.seed, self.end, self.listener = question, variables, seed, end, listener
        self.began = monotonic()
        self.exact = Variables(question)
        self.limits = Limits(question)
        self.rough = at_few_depths(question)
        self.penalty = penalty
        self.generator = torch.Generator().manual_seed(seed)
        self.elite = Elite(MOST_ELITE)
        self.incumbent: Candidate | None = None
        self.polished_values: list[float] = []
        self.best_value, self.alive, self.out_of_time = inf, 0, False
        self.tally = Tally()

    @cached_property
    def foci(self) -> Foci:
        """What chooses the foci of waves; made when the first asks."""
        return Foci(self.rough, self.variables, self.generator)

    @cached_property
    def seer(self) -> Seer:
        """What looks at many layouts; made when the first wave asks, for the sketch does not wait for it."""
        return Seer(self.rough, self.variables)

    @property
    def best(self) -> Candidate:
        """The best layout so far, as it would be claimed."""
        assert self.incumbent is not None
        return self.incumbent

    def know(self, known: Sequence[Layout], batch: int) -> None:
        """Claim layouts that are known, polish the best of them as it is, and settle all."""
        known = [layout for layout in known if self.question.score(layout).isfinite()]
        self.alive += len(known)
        for layout in known:
            if not self._claim(layout.to(torch.float64)).certificate.feasible:
                self._claim(tighten(self.limits, self.exact.layout(self.exact.vector(layout))))
        if known:
            self._polish(self.best.layout)
        for few in (known[first : first + batch] for first in range(0, len(known), batch)):
            if self._late():
                break
            share = torch.stack([self.variables.spread(self.variables.vector(layout)) for layout in few])
            settled = self._settle(share, FROM_NEARBY, afresh=False)
            self._take(settled, None)
            # Settling may lead away from a layout that is as good as can be.
            self._keep(share)

    def choose(self) -> None:
        """Claim what is chosen before any wave, as it comes and polished, and keep the polished to be varied."""
        tried, foci = tried_places(self.question.back, self.seed), Foci(self.question, self.exact, self.generator)
        first = first_layouts(self.question, self.exact, foci, self.limits, tried, self.generator, self.end)
        kept: list[Tensor] = []
        try:
            for share, worth_a_polish in first:
                self._claim(self.exact.layout_of(share))
                self.tell("starts", 0.0, 0)
                if worth_a_polish and (found := self._polish(self.exact.layout_of(share))):
                    kept.append(self.variables.spread(self.variables.vector(found.layout)))
                    self.tell("starts", 0.0, 0)
        except OutOfTimeError:
            self.out_of_time = True
        if kept:
            self.seer.calibrate(share := torch.stack(kept))
            self._keep(share)

    def open(self, starts: int, batch: int) -> None:
        """Settle fresh starts, a batch at a time."""
        radii, price = slice(2 * self.exact.count, self.exact.focus_start), self.penalty(self.question)
        # The first answer is waited for: few layouts come first where many lenses make them slow.
        at_first = min(batch, max(1, LENSES_AT_FIRST // self.exact.count))
        for first, last in pairwise([0, *range(at_first, starts, batch), starts]):
            if first and self._late():
                break
            vectors = scattered_starts(self.question, self.exact, last - first, self.seed, first)
            share = self.exact.spread(vectors).to(self.variables.low)
            share[:, radii] *= 0.5
            settled = self._settle(part(self.variables, price, share), FROM_AFAR, afresh=True)
            self.tally.histories.append(self._scores(settled.history))
            self.alive += int(settled.value.isfinite().sum())
            self._take(settled, first)
            self.tell("starts", last / starts, last)

    def vary(self, patience: int, batch: int) -> None:
        """Settle variations of the best until there is no progress for a while."""
        lens = min(self.question.lenses, key=lambda lens: lens.least_body_radius)
        tried, room = tried_places(self.question.back, self.seed)
        varier = Varier(self.variables, tried[room >= lens.least_body_radius], self.generator)
        idle = 0
        while idle < patience and len(self.elite.value) and not self._late():
            before = self.best_value
            settled = self._settle(varier(self.elite.share, batch), FROM_NEARBY, afresh=False)
            self._take(settled, None)
            idle = 0 if self.best_value < before - PROGRESS else idle + 1
            self.tell("variations", idle / patience, self.alive)

    def finish(self) -> None:
        """Polish the best to the end."""
        if self.incumbent is None or self._late():
            return
        try:
            x = polish(self.question, self.exact, self.exact.vector(self.best.layout), self.end)
        except OutOfTimeError:
            self.out_of_time = True
            return
        self._claim(self.exact.layout(x))
        self.tell("polish", 1.0, self.alive)

    def _keep(self, share: Tensor) -> None:
        """Keep those that are feasible, as they are, to be varied."""
        sight = self.seer.look(share, LAST)
        self.elite.add(share, torch.where((sight.room >= 0).all(-1), sight.value, torch.inf))

    def _settle(self, share: Tensor, pressure: float, afresh: bool) -> Settled:
        settings = BarrierSettings(STEPS + STEPS_PER_LENS * self.exact.count, (pressure, LAST))
        share = self.foci.afresh(share) if afresh else self.foci.improved(share)
        return settle(
            self.seer, share, settings, lambda: not self._late(FIRST_ANSWER if self.incumbent is None else 0.0)
        )

    def _take(self, settled: Settled, first: int | None) -> None:
        """Add what a wave found, and polish the best of it if that may be the best of all."""
        healthy = settled.value.isfinite()
        merit = torch.where(settled.feasible & healthy, settled.value, torch.inf)
        self.elite.add(settled.share, merit)
        at = int(merit.argmin())
        if not merit[at].isfinite():
            # Better one that lacks a little room than none.
            at = int(torch.where(healthy, settled.missing, torch.inf).argmin())
        elif merit[at] > self.best_value + WORTH_A_POLISH:
            return
        self.best_value = min(self.best_value, float(merit[at]))
        if any(abs(float(merit[at]) - value) < ALIKE for value in self.polished_values):
            return
        self.polished_values.append(float(merit[at]))
        chosen = self.foci.best_for(settled.share[at]).cpu().double()
        layout = self.exact.layout_of(chosen)
        claimed = self._claim(tighten(self.limits, layout))
        if self._late():
            return
        polished = self._polish(layout)
        if first is not None and polished is not None:
            self.tally.polished.append(first + at)
            self.tally.scores.append(polished.score if polished.certificate.feasible else claimed.score)

    def _polish(self, layout: Layout) -> Candidate | None:
        """Claim what a rough polish makes of a layout, unless time runs out."""
        try:
            x = polish(self.rough, self.exact, self.exact.vector(layout), self.end, ROUGH)
        except OutOfTimeError:
            self.out_of_time = True
            return None
        return self._claim(self.exact.layout(x))

    def _claim(self, layout: Layout) -> Candidate:
        candidate = Candidate.of(self.question, layout)
        if candidate.better_than(self.incumbent):
            self.incumbent = candidate
        return candidate

    def _scores(self, history: Tensor) -> Tensor:
        scores = history.exp() if self.seer.scale is None else history * self.seer.scale
        return scores.cpu().double()

    def _late(self, grace: float = 0.0) -> bool:
        late = monotonic() > self.end + grace
        self.out_of_time |= late
        return late

    def tell(self, stage: str, done: float, starts: int) -> None:
        """Tell the listener how far the search has come."""
        feasible = self.incumbent is not None and self.incumbent.certificate.feasible
        layout = self.incumbent.layout if feasible and self.incumbent is not None else None
        score = self.incumbent.score if feasible and self.incumbent is not None else nan
        now = monotonic()
        left = (
            min((now - self.began) * (1 / max(done, 1e-3) - 1), self.end - now) if stage == "starts" else self.end - now
        )
        self.listener(Progress(stage, done, starts, self.alive, score, layout, left, self.question.metric))
