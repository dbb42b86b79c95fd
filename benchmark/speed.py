"""How many designs a second are valued with their gradient, against the same objective written plainly in eager torch."""

from collections.abc import Callable, Sequence
from itertools import product
from statistics import median
from time import perf_counter
from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor

import multilens as ml
from benchmark.problems import main_lens, rectangle

BATCH, LENSES, DEPTHS = 256, 8, 128

BATCHES = (32, 64, 256, 1024, 4096)
"""Designs at once. The plain one is at its best with 32 or 64, whose errors at all depths stay in the processor's cache, the
library with thousands, where calling torch costs little beside what it computes."""

QUICK_BATCHES = (32, 64, 2048)

BEST = "best of each"

REPEATS = 3
"""Timings of which the median counts; ours and the plain one in turn."""

LEAST_SECONDS = 0.15
"""Of each timing."""


def question(lenses: int = LENSES, depths: int = DEPTHS) -> ml.Problem:
    """Give the problem that is evaluated."""
    return ml.Problem(rectangle(), [main_lens()] * lenses, ml.log_depths(200, 5000, depths))


def random_layouts(problem: ml.Problem, batch: int, kind: dict[str, Any], seed: int = 0) -> ml.Layout:
    """Give a batch of layouts spread over the back's bounding box and the bounds, that ask for gradients."""
    generator = torch.Generator().manual_seed(seed)
    n = len(problem.lenses)
    left, top, right, bottom = problem.back.outline.bounds
    corner, size = (torch.tensor(pair, dtype=torch.float64) for pair in ([left, top], [right - left, bottom - top]))
    low, high = torch.tensor([lens.aperture_radius for lens in problem.lenses], dtype=torch.float64).T
    near, far = torch.tensor(problem.focus_range, dtype=torch.float64).T
    position = corner + size * torch.rand(batch, n, 2, generator=generator, dtype=torch.float64)
    radius = low + (high - low) * torch.rand(batch, n, generator=generator, dtype=torch.float64)
    focus = near * (far / near) ** torch.rand(batch, n, generator=generator, dtype=torch.float64)
    return ml.Layout(*(part.to(**kind).requires_grad_() for part in (position, radius, focus.unsqueeze(-1))))


def plain_score(problem: ml.Problem, layout: ml.Layout) -> Float[Tensor, " b"]:
    """Give the score by all pairs and all lenses, as one would write it in torch without further thought: broadcast and amin."""
    kind = {"dtype": layout.position.dtype, "device": layout.position.device}
    depths, weights = problem.depths.to(**kind), problem.weights.to(**kind)
    noise = torch.tensor([lens.disparity_noise / lens.focal_length for lens in problem.lenses], **kind)
    blur = torch.tensor([lens.blur_noise / (2 * lens.focal_length) for lens in problem.lenses], **kind)
    first, second = torch.triu_indices(len(noise), len(noise), 1, device=kind["device"])
    baseline = (layout.position[:, first] - layout.position[:, second]).norm(dim=-1)
    pair_noise = ((noise[first] ** 2 + noise[second] ** 2) / 2).sqrt()
    stereo = (pair_noise / baseline)[..., None] * depths**2
    miss = (depths - layout.focus).abs()
    defocus = (blur / layout.aperture_radius)[..., None] * depths * miss
    return (weights * torch.cat([stereo, defocus], dim=1).amin(1) ** 2).sum(-1)


def seconds_each(function: Callable[[], object]) -> float:
    """Give the mean time of a call over some tenths of a second, after one call that does not count."""
    function()
    calls, began = 0, perf_counter()
    while perf_counter() - began < LEAST_SECONDS:
        function()
        calls += 1
    return (perf_counter() - began) / calls


def value_and_gradient(score: Callable[[ml.Layout], Tensor], layout: ml.Layout) -> tuple[Tensor, ...]:
    """Give the gradient of the sum of the scores in position, radius and focus."""
    return torch.autograd.grad(score(layout).sum(), (layout.position, layout.aperture_radius, layout.focus))


def speed_table(devices: Sequence[str] = ("cpu",), batches: Sequence[int] = BATCHES) -> list[list[Any]]:
    """Give a row for each type, device and batch, head first: designs a second of the library, of plain torch, and their ratio.

    The last row of each type and device has the best of all batches of the one against the best of the other.

    Args:
        devices: on which to measure.
        batches: designs at once.
    """
    rows: list[list[Any]] = [
        ["type", "device", "batch", "multilens (designs/s)", "plain eager torch (designs/s)", "ratio"]
    ]
    for device, dtype in product(devices, (torch.float32, torch.float64)):
        kind = [str(dtype).removeprefix("torch."), device]
        rates = [_rates(batch, {"dtype": dtype, "device": device}) for batch in batches]
        shown = zip([*batches, BEST], [*rates, [max(each) for each in zip(*rates, strict=True)]], strict=True)
        rows += [[*kind, batch, ours, plain, ours / plain] for batch, (ours, plain) in shown]
    return rows


def _rates(batch: int, kind: dict[str, Any]) -> list[float]:
    """Give how many designs of a batch the library values a second with their gradient, and how many plain torch does."""
    problem = question()
    layout = random_layouts(problem, batch, kind)

    def timed(score: Callable[[ml.Layout], Tensor]) -> float:
        # Reading one number waits for a device that computes on its own.
        return seconds_each(lambda: value_and_gradient(score, layout)[0][0, 0, 0].item())

    pairs = [(timed(problem.score), timed(lambda each: plain_score(problem, each))) for _ in range(REPEATS)]
    return [batch / median(times) for times in zip(*pairs, strict=True)]
