"""What moves after a camera was calibrated, and how far off the depth is that is read without knowing it.

All lengths in millimetres, vergences (one over a depth) in 1/mm: a thousandth of a dioptre is 1e-6 /mm. Every function is
elementwise: its arguments broadcast, and dtype and device follow them. Derivations: docs/robustness.md.
"""

from jaxtyping import Float
from torch import Tensor

FARTHEST = 1e6
"""mm; a kilometre stands for infinity: a lens that drifts beyond is focused there."""


def refocused(focus: Float[Tensor, "..."], vergence: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give the in-focus depth of a lens whose sensor stands too near or too far, 1 / (1/Zf + d).

    A sensor that is dv too far from its lens adds d = dv / v0^2, whatever the depth; see `sensor_shift_to_vergence`.

    Args:
        focus: Zf that was meant, mm, > 0.
        vergence: d, 1/mm, of any sign.

    Returns:
        Zf as it is, mm, > 0 and at most a kilometre.

    Reference:
        The Gaussian lens formula, 1/f = 1/Zf + 1/v0.
    """
    return 1 / (1 / focus + vergence).clamp(min=1 / FARTHEST)


def sensor_shift_to_vergence(
    shift: Float[Tensor, "..."], sensor_distance: Float[Tensor, "..."]
) -> Float[Tensor, "..."]:
    """Give by how much 1/Zf grows when the sensor moves away from the lens, d = dv / v0^2.

    Args:
        shift: dv, mm, positive away from the lens, small beside v0.
        sensor_distance: v0, mm, > 0.

    Returns:
        d, 1/mm; times 1000 it is in dioptres.

    Reference:
        Derivative of the Gaussian lens formula, 1/Zf = 1/f - 1/v0.
    """
    return shift / sensor_distance**2


def focus_drift_error(depth: Float[Tensor, "..."], vergence: Float[Tensor, "..."]) -> Float[Tensor, "..."]:
    """Give the depth error of defocus whose 1/Zf is off by d, Z^2 d.

    Defocus reads 1/Z = 1/Zf + a / (A f): what 1/Zf is off by, 1/Z is off by.

    Args:
        depth: Z, mm, > 0.
        vergence: d, 1/mm, >= 0.

    Returns:
        Depth error, mm.

    Reference:
        Derivative of the thesis' equation 5.3 with respect to 1/Zf.
    """
    return depth**2 * vergence


def direction_drift(
    depth: Float[Tensor, "..."],
    focal_length: Float[Tensor, "..."],
    shift: Float[Tensor, "..."],
    decentre: Float[Tensor, "..."],
) -> Float[Tensor, "..."]:
    """Give by how much a camera mistakes the direction of a point, sqrt((s/Z)^2 + (e/f + e/Z)^2).

    A camera that moved aside by s sees the point s/Z off. A lens that moved over its own sensor by e moves the image with it:
    e/f more.

    Args:
        depth: Z, mm, > 0.
        focal_length: f, mm, > 0.
        shift: s, standard deviation of how far lens and sensor have moved together along an axis, mm, >= 0.
        decentre: e, the same of the lens over its sensor, mm, >= 0.

    Returns:
        Standard deviation of the direction along that axis, rad.

    Reference:
        Similar triangles; docs/robustness.md.
    """
    return ((shift / depth) ** 2 + (decentre / focal_length + decentre / depth) ** 2).sqrt()


def pair_drift_error(
    depth: Float[Tensor, "..."],
    baseline: Float[Tensor, "..."],
    first: Float[Tensor, "..."],
    second: Float[Tensor, "..."],
) -> Float[Tensor, "..."]:
    """Give the depth error of a pair whose directions are off, Z^2 / b * sqrt(a1^2 + a2^2).

    Args:
        depth: Z, mm, > 0.
        baseline: b, mm, > 0.
        first: a1, standard deviation of the direction of one camera along the baseline, rad, >= 0.
        second: a2, that of the other, independent, rad, >= 0.

    Returns:
        Standard deviation of the depth, mm.

    Reference:
        Thesis, equation 4.3, with the difference of two angles for the disparity over the focal length.
    """
    return depth**2 / baseline * (first**2 + second**2).sqrt()
