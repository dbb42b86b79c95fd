"""multilens: where the lenses of a multi-camera depth sensor go, how wide they open and where they focus.

Lengths are millimetres throughout. The names below are the whole public interface; each is loaded when it is first used, so
that importing the package, and asking the command line for help, costs next to nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from multilens.back import Back as Back
    from multilens.bounds.bound import Bound as Bound
    from multilens.bounds.bound import lower_bound as lower_bound
    from multilens.cad.export import export as export
    from multilens.cad.read import read_back as read_back
    from multilens.cues import LensDefocus as LensDefocus
    from multilens.cues import LimitedStereo as LimitedStereo
    from multilens.cues import PairLimits as PairLimits
    from multilens.cues import PairStereo as PairStereo
    from multilens.cues import PhotometricDefocus as PhotometricDefocus
    from multilens.cues import PhotometricStereo as PhotometricStereo
    from multilens.cues import PrintedDefocus as PrintedDefocus
    from multilens.cues.drift import Drift as Drift
    from multilens.depths import histogram_weights as histogram_weights
    from multilens.depths import linear_depths as linear_depths
    from multilens.depths import log_depths as log_depths
    from multilens.design import Design as Design
    from multilens.disturbance import Disturbance as Disturbance
    from multilens.field_of_view import Field as Field
    from multilens.fusion import Best as Best
    from multilens.fusion import InverseVariance as InverseVariance
    from multilens.geometry.shape import disc as disc
    from multilens.geometry.shape import polygon as polygon
    from multilens.geometry.shape import rectangle as rectangle
    from multilens.inverse.least import fewest_lenses as fewest_lenses
    from multilens.inverse.least import smallest_aperture as smallest_aperture
    from multilens.inverse.least import smallest_back as smallest_back
    from multilens.layout import Layout as Layout
    from multilens.lens import Lens as Lens
    from multilens.metrics import InverseDepth as InverseDepth
    from multilens.metrics import MeanSquare as MeanSquare
    from multilens.metrics import Relative as Relative
    from multilens.metrics import WorstCase as WorstCase
    from multilens.penalty import area_penalty as area_penalty
    from multilens.penalty import distance_penalty as distance_penalty
    from multilens.problem import Problem as Problem
    from multilens.report.write import write_report as write_report
    from multilens.robust import Robust as Robust
    from multilens.scene import Scene as Scene
    from multilens.score_problem import ScoreProblem as ScoreProblem
    from multilens.search.evaluate import evaluate as evaluate
    from multilens.search.neighbours import carried_over as carried_over
    from multilens.search.solve import solve as solve
    from multilens.sensor import Sensor as Sensor
    from multilens.tolerance import Tolerance as Tolerance
    from multilens.working_range import WorkingRange as WorkingRange

_HOME = {
    "Back": "back",
    "Best": "fusion",
    "Bound": "bounds.bound",
    "Design": "design",
    "Disturbance": "disturbance",
    "Drift": "cues.drift",
    "Field": "field_of_view",
    "InverseDepth": "metrics",
    "InverseVariance": "fusion",
    "Layout": "layout",
    "Lens": "lens",
    "LensDefocus": "cues",
    "LimitedStereo": "cues",
    "MeanSquare": "metrics",
    "PairLimits": "cues",
    "PairStereo": "cues",
    "PhotometricDefocus": "cues",
    "PhotometricStereo": "cues",
    "PrintedDefocus": "cues",
    "Problem": "problem",
    "Relative": "metrics",
    "Robust": "robust",
    "Scene": "scene",
    "ScoreProblem": "score_problem",
    "Sensor": "sensor",
    "Tolerance": "tolerance",
    "WorkingRange": "working_range",
    "WorstCase": "metrics",
    "area_penalty": "penalty",
    "carried_over": "search.neighbours",
    "disc": "geometry.shape",
    "distance_penalty": "penalty",
    "evaluate": "search.evaluate",
    "export": "cad.export",
    "fewest_lenses": "inverse.least",
    "histogram_weights": "depths",
    "linear_depths": "depths",
    "log_depths": "depths",
    "lower_bound": "bounds.bound",
    "polygon": "geometry.shape",
    "read_back": "cad.read",
    "rectangle": "geometry.shape",
    "smallest_aperture": "inverse.least",
    "smallest_back": "inverse.least",
    "solve": "search.solve",
    "write_report": "report.write",
}


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted(_HOME)
