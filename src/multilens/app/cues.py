"""From the cues that a configuration names to cues. Only `build_cues` needs torch."""

from math import isfinite
from typing import TYPE_CHECKING

from multilens.app.refusal import RefusedError
from multilens.app.schema import CueName, CuesConfig, PairLimitsConfig

if TYPE_CHECKING:
    from multilens.cues import Cue

LIMITED = (CueName["limited_stereo"],)
"""The cues that ask when a pair may be used."""


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
    if limits != PairLimitsConfig() and not set(LIMITED) & set(config.names):
        words, given = (", ".join(cue.name for cue in names) for names in (LIMITED, config.names))
        raise RefusedError(f"cues.limits are for {words}, got cues.names of {given}, which have none")


def build_cues(config: CuesConfig) -> "list[Cue]":
    """Make the cues in the order in which they are named."""
    from multilens.cues import LensDefocus, LimitedStereo, PairLimits, PairStereo

    limits = PairLimits(config.limits.max_disparity, config.limits.least_overlap)
    cues = {
        CueName["stereo"]: PairStereo(),
        CueName["defocus"]: LensDefocus(),
        CueName["limited_stereo"]: LimitedStereo(limits),
    }
    return [cues[name] for name in config.names]
