"""Cues: what can be measured at a depth, by which lenses, and how far off the measured depth will be."""

from multilens.cues.cue import Cue, FactoredCue, LimitedCue, Measurement
from multilens.cues.thesis import NANOMETRE, LensDefocus, PairStereo

__all__ = ["CUES", "NANOMETRE", "Cue", "FactoredCue", "LensDefocus", "LimitedCue", "Measurement", "PairStereo"]

CUES = {"pair_stereo": PairStereo, "lens_defocus": LensDefocus}
"""Every cue that a file or a command line may name. What is not in this table is never imported or called."""
