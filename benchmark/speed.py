"""How many designs a second are valued with their gradient, against the same objective written plainly in eager torch."""

from collections.abc import Callable
from itertools import product
from time import perf_counter
from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor

import multilens as ml
from benchmark.problems import main_lens, rectangle

BATCH, LENSES, DEPTHS = 256, 8, 128

BATCHES = (256, 1024, 4096)
"""Designs at once: small batches are mostly what calling torch costs, large ones leave the processor's cache."""

REPEATS = 5
"""Timings of which the median counts; ours and the plain one in turn."""

LEAST_SECONDS = 0.3
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
    """Give the mean time of a call over a third of a second, after one call that does not count."""
    function()
    calls, began = 0, perf_counter()
    while perf_counter() - began < LEAST_SECONDS:
        function()
        calls += 1
    return (perf_counter() - began) / calls


def value_and_gradient(score: Callable[[ml.Layout], Tensor], layout: ml.Layout) -> tuple[Tensor, ...]:
    """Give the gradient of the sum of the scores in position, radius and focus."""
    return torch.autograd.grad(score(layout).sum(), (layout.position, layout.aperture_radius, layout.focus))


def speed_table(devices: tuple[str, ...] = ("cpu",), batches: tuple[int, ...] = BATCHES) -> list[list[Any]]:
    """Give a row for each type and device, head first: designs a second of the library, of plain torch, and their ratio.

    Args:
        devices: on which to measure.
        batches: designs at once.
    """
    rows: list[list[Any]] = [
        ["type", "device", "batch", "multilens (designs/s)", "plain eager torch (designs/s)", "ratio"]
    ]
    problem = question()
    for device in devices:
        for dtype, batch in product((torch.float32, torch.float64), batches):
            layout = random_layouts(problem, batch, {"dtype": dtype, "device": device})

            def timed(score: Callable[[ml.Layout], Tensor], at: ml.Layout = layout) -> float:
                def once() -> float:
                    # Reading one number waits for a device that computes on its own.
                    return value_and_gradient(score, at)[0][0, 0, 0].item()

                return seconds_each(once)

            pairs = [(timed(problem.score), timed(lambda each: plain_score(problem, each))) for _ in range(REPEATS)]
            ours, plain = (sorted(times)[REPEATS // 2] for times in zip(*pairs, strict=True))
            name = str(dtype).removeprefix("torch.")
            rows.append([name, device, batch, batch / ours, batch / plain, plain / ours])
    return rows
