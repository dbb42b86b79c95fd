"""The thesis' model of two lenses on a line, as it is written in its chapter 6, in torch instead of TensorFlow.

All lengths in millimetres. What the thesis does not state (focal lengths, number of depths, optimiser, step, iterations, what
keeps theta between 0 and 1) is an argument here; the study's README lists the values that were chosen.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import torch
from jaxtyping import Float
from torch import Tensor

LENGTH, LEAST_RADIUS = 50.0, 1.0
"""max_length L and r_min of figure 7.1, mm."""

LONGEST_GAP = LENGTH - 4 * LEAST_RADIUS
"""max_baseline: both lenses pinholes."""

LARGEST_RADIUS = (LENGTH - 2 * LEAST_RADIUS) / 2
"""max_r_dfdd: the second lens takes all that the first leaves."""

SMALLEST_GAP = 1e-6
"""mm; keeps Z^2 / b finite where theta_b is 0."""


@dataclass(frozen=True)
class Arrangement:
    """The two lenses: a pinhole, a gap, and a lens of aperture radius A focused at Zf.

    Args:
        gap: b, between the rims of the two apertures, mm.
        focus: Zf, mm.
        aperture_radius: A, mm.
    """

    gap: Float[Tensor, "*batch"]
    focus: Float[Tensor, "*batch"]
    aperture_radius: Float[Tensor, "*batch"]

    @property
    def length_used(self) -> Float[Tensor, "*batch"]:
        """Give b + 2 r_min + 2 A, mm."""
        return self.gap + 2 * LEAST_RADIUS + 2 * self.aperture_radius


def initial_thetas(seeds: int) -> Float[Tensor, "seeds 3"]:
    """Draw theta_b ~ U(0.01, 0.1), theta_Zf ~ U(0.3, 0.9) and theta_A ~ U(0.01, 0.1) for the seeds 0, 1, 2, ..."""
    low, high = torch.tensor([0.01, 0.3, 0.01]).double(), torch.tensor([0.1, 0.9, 0.1]).double()
    draws = [torch.rand(3, generator=torch.Generator().manual_seed(seed), dtype=torch.float64) for seed in range(seeds)]
    return low + (high - low) * torch.stack(draws)


def arrangement(theta: Float[Tensor, "*batch 3"], depths: Float[Tensor, "*batch z"]) -> Arrangement:
    """Give what theta stands for: b = (L - 4 r) theta_b, Zf = Zmin + (Zmax - Zmin) theta_Zf, A = (L - 2 r)/2 theta_A."""
    near, far = depths.amin(-1), depths.amax(-1)
    return Arrangement(LONGEST_GAP * theta[..., 0], near + (far - near) * theta[..., 1], LARGEST_RADIUS * theta[..., 2])


def stereo_error(
    lenses: Arrangement, depths: Float[Tensor, "*batch z"], focal_length: float | Tensor
) -> Float[Tensor, "*batch z"]:
    """Give err_stereo = Z^2 / (b f_stereo)."""
    return depths**2 / (lenses.gap.clamp(min=SMALLEST_GAP).unsqueeze(-1) * focal_length)


def defocus_error(
    lenses: Arrangement, depths: Float[Tensor, "*batch z"], focal_length: float | Tensor
) -> Float[Tensor, "*batch z"]:
    """Give err_dfdd = Z abs(Z - Zf) / (2 A f_dfdd)."""
    away = (depths - lenses.focus.unsqueeze(-1)).abs()
    return depths * away / (2 * lenses.aperture_radius.clamp(min=SMALLEST_GAP).unsqueeze(-1) * focal_length)


def loss(
    lenses: Arrangement, depths: Float[Tensor, "*batch z"], f_stereo: float | Tensor, f_dfdd: float | Tensor
) -> Float[Tensor, "*batch"]:
    """Give y = mean over Z of (min(err_stereo, err_dfdd) + relu(abs(length used - L)))^2.

    As with the masks of the thesis' snippet, the gradient of each depth flows through the winning cue alone.
    """
    best = torch.minimum(stereo_error(lenses, depths, f_stereo), defocus_error(lenses, depths, f_dfdd))
    penalty = torch.relu((lenses.length_used - LENGTH).abs())
    return (best + penalty.unsqueeze(-1)).square().mean(-1)


@dataclass(frozen=True)
class GradientDescent:
    """theta <- clip(theta - step * gradient, 0, 1).

    Args:
        iterations: how many.
        step: of the first iteration.
        fading: let the step fall in a straight line to 0; otherwise it stays.
        adam: divide the gradient by its running root mean square, as TensorFlow's Adam does.
    """

    iterations: int
    step: float
    fading: bool = False
    adam: bool = False


def iterates(
    theta: Float[Tensor, "*batch 3"],
    depths: Float[Tensor, "*batch z"],
    f_stereo: float | Tensor,
    f_dfdd: float | Tensor,
    settings: GradientDescent,
) -> Iterator[Float[Tensor, "*batch 3"]]:
    """Let every theta of the batch descend by itself; give where they are after each iteration."""
    mean, square = torch.zeros_like(theta), torch.zeros_like(theta)
    for iteration in range(1, settings.iterations + 1):
        theta = theta.detach().requires_grad_()
        total = loss(arrangement(theta, depths), depths, f_stereo, f_dfdd).sum()
        (gradient,) = torch.autograd.grad(total, theta)
        with torch.no_grad():
            if settings.adam:
                mean = 0.9 * mean + 0.1 * gradient
                square = 0.999 * square + 0.001 * gradient**2
                gradient = mean / (1 - 0.9**iteration) / ((square / (1 - 0.999**iteration)).sqrt() + 1e-7)
            step = settings.step * (1 - (iteration - 1) / settings.iterations if settings.fading else 1)
            theta = (theta - step * gradient).clamp(0, 1)
        yield theta
