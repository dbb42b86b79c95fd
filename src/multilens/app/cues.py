"""From the cues that a configuration names to cues. Only `build_cues` needs torch."""

from math import isfinite
from typing import TYPE_CHECKING

from multilens.app.refusal import RefusedError, refused_at
from multilens.app.schema_cues import CueName, CuesConfig, RelativeErrorsConfig, TwoImagesConfig
from multilens.ranges import refuse_unless_not_negative, refuse_unless_positive, refuse_unless_share
from multilens.scene import Scene

if TYPE_CHECKING:
    from multilens.cues import Cue

READ_BY = {
    "limits": (CueName["limited_stereo"], CueName["photometric_stereo"]),
    "two_images": (CueName["photometric_defocus"],),
    "relative_errors": (CueName["printed_defocus"],),
}
"""The cues that read each part of the configuration; beside others alone it would count for nothing."""


def check_cues(config: CuesConfig) -> None:
    """Check names and ranges, without torch.

    Raises:
        RefusedError: a number is out of its range, or something does not go together.
    """
    if not config.names or len(set(config.names)) < len(config.names):
        given = ", ".join(cue.name for cue in config.names) or "none"
        words = ", ".join(cue.name for cue in CueName)
        raise RefusedError(f"cues.names must be at least one of {words}, each once, got {given}")
    limits = config.limits
    most = limits.max_disparity
    if most is not None and not (isfinite(most) and most > 0):
        raise RefusedError(f"cues.limits.max_disparity must be > 0 mm and finite, or null for any, got {most:g}")
    if not 0 <= limits.least_overlap < 1:
        raise RefusedError(f"cues.limits.least_overlap must be >= 0 and < 1, got {limits.least_overlap:g}")
    for part, readers in READ_BY.items():
        if getattr(config, part) != getattr(CuesConfig(), part) and not set(readers) & set(config.names):
            words, given = (", ".join(cue.name for cue in names) for names in (readers, config.names))
            raise RefusedError(f"cues.{part} are for {words}, got cues.names of {given}, which have none")
    if CueName["photometric_defocus"] in config.names:
        _check_two_images(config.two_images)
    if CueName["printed_defocus"] in config.names:
        _check_relative_errors(config.relative_errors)


def build_cues(config: CuesConfig, scene: Scene) -> "list[Cue]":
    """Make the cues in the order in which they are named."""
    from multilens.cues import (
        LensDefocus,
        LimitedStereo,
        PairLimits,
        PairStereo,
        PhotometricDefocus,
        PhotometricStereo,
        PrintedDefocus,
    )

    limits = PairLimits(config.limits.max_disparity, config.limits.least_overlap)
    images, errors = config.two_images, config.relative_errors
    change, part = images.power_change_dioptres or 0.0, errors.change or 0.0
    make = {
        CueName["stereo"]: PairStereo,
        CueName["defocus"]: LensDefocus,
        CueName["limited_stereo"]: lambda: LimitedStereo(limits),
        CueName["photometric_stereo"]: lambda: PhotometricStereo(scene, limits),
        CueName["photometric_defocus"]: lambda: PhotometricDefocus(
            scene, change, images.light_share, images.frequency_error
        ),
        CueName["printed_defocus"]: lambda: PrintedDefocus(errors.frequency, errors.amplitude, part),
    }
    return [make[name]() for name in config.names]


def _check_two_images(config: TwoImagesConfig) -> None:
    change = config.power_change_dioptres
    if change is None:
        raise RefusedError("cues.two_images.power_change_dioptres must be set for photometric_defocus, got null")
    with refused_at("cues.two_images"):
        refuse_unless_positive("power_change_dioptres", change)
        refuse_unless_share("light_share", config.light_share)
        refuse_unless_not_negative("frequency_error", config.frequency_error)


def _check_relative_errors(config: RelativeErrorsConfig) -> None:
    if config.change is None:
        raise RefusedError("cues.relative_errors.change must be set for printed_defocus, got null")
    with refused_at("cues.relative_errors"):
        refuse_unless_not_negative("frequency", config.frequency)
        refuse_unless_not_negative("amplitude", config.amplitude)
        refuse_unless_positive("change", config.change)
