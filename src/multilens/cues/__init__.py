"""Cues: what can be measured at a depth, by which lenses, and how far off the measured depth will be."""

from multilens.cues.cue import Cue, FactoredCue, FusedCue, LimitedCue, Measurement
from multilens.cues.limited import LimitedStereo
from multilens.cues.limits import PairLimits
from multilens.cues.photometric import PhotometricDefocus, PhotometricStereo
from multilens.cues.printed import PrintedDefocus
from multilens.cues.thesis import NANOMETRE, LensDefocus, PairStereo

__all__ = [
    "CUES",
    "NANOMETRE",
    "Cue",
    "FactoredCue",
    "FusedCue",
    "LensDefocus",
    "LimitedCue",
    "LimitedStereo",
    "Measurement",
    "PairLimits",
    "PairStereo",
    "PhotometricDefocus",
    "PhotometricStereo",
    "PrintedDefocus",
]

CUES = {
    "pair_stereo": PairStereo,
    "lens_defocus": LensDefocus,
    "limited_stereo": LimitedStereo,
    "photometric_stereo": PhotometricStereo,
    "photometric_defocus": PhotometricDefocus,
    "printed_defocus": PrintedDefocus,
}
"""Every cue that a file or a command line may name. What is not in this table is never imported or called."""
