"""Lenses and problems to a file and back, and what is said of a file that is wrong."""

import json
from dataclasses import dataclass, fields

import pytest
from hypothesis import given
from hypothesis import strategies as st

from multilens.back import Back
from multilens.cues import (
    CUES,
    LensDefocus,
    LimitedStereo,
    PairLimits,
    PairStereo,
    PhotometricDefocus,
    PhotometricStereo,
    PrintedDefocus,
)
from multilens.cues.drift import Drift
from multilens.depths import log_depths
from multilens.disturbance import Disturbance
from multilens.field_of_view import Field
from multilens.fusion import InverseVariance
from multilens.geometry.shape import disc
from multilens.lens import Lens
from multilens.metrics import METRICS
from multilens.problem import Problem
from multilens.records import lens_record, problem_record, read_lens, read_problem
from multilens.robust import Robust
from multilens.scene import Scene
from multilens.score_problem import ScoreProblem
from multilens.sensor import Sensor


def through_json(value):
    """What a file gives back."""
    return json.loads(json.dumps(value, allow_nan=False))


lengths = st.floats(1e-3, 1e3)
coordinates = st.floats(-1e5, 1e5)


@st.composite
def ranges(draw):
    return tuple(sorted((draw(lengths), draw(lengths))))


@st.composite
def lenses(draw):
    return Lens(
        focal_length=draw(lengths),
        aperture_radius=draw(ranges()),
        focus=draw(st.none() | ranges()),
        clearance=draw(st.just(0) | lengths),
        disparity_noise=draw(lengths),
        blur_noise=draw(lengths),
        tiers=draw(st.integers(1, 4)),
        position=draw(st.none() | st.tuples(st.none() | coordinates, st.none() | coordinates)),
        field_of_view_deg=draw(st.none() | st.floats(1, 179)),
        sensor=draw(st.none() | st.builds(Sensor, lengths, lengths, lengths, st.floats(0.01, 1))),
    )


@given(lenses())
def test_a_lens_comes_back(lens):
    assert read_lens(through_json(lens_record(lens)), "lens") == lens


weights = st.lists(st.floats(0, 1e6), min_size=2, max_size=40).filter(lambda all_of_them: sum(all_of_them) > 1e-6)


@given(weights)
def test_a_problem_comes_back_to_the_bit(given_weights):
    depths = log_depths(200, 5000, len(given_weights))
    problem = Problem(Back.disc(30), [Lens(5, (1, 2))] * 2, depths, given_weights, [LensDefocus(), PairStereo()], 0.1)
    again = read_problem(through_json(problem_record(problem)), "problem")
    assert again.weights.numpy().tobytes() == problem.weights.numpy().tobytes()
    assert again.depths.numpy().tobytes() == problem.depths.numpy().tobytes()
    assert (again.lenses, again.cues, again.gap) == (problem.lenses, problem.cues, problem.gap)


SCENE = Scene(0.3, 40, 300, 30, 1024, frequency_on="object")
EVERY_CUE = (
    PairStereo(),
    LensDefocus(),
    LimitedStereo(PairLimits(max_disparity=0.4, least_overlap=0.1)),
    PhotometricStereo(SCENE, PairLimits(least_overlap=1 / 3)),
    PhotometricDefocus(SCENE, 0.7, light_share=0.5, frequency_error=1e-3),
    PrintedDefocus(0.01, 0.02, 0.03),
)
SEEING = Lens(5, (1, 2), sensor=Sensor(1.22, 6000, 2, 0.5))


def test_every_cue_of_the_table_comes_back_with_what_it_holds():
    assert {type(cue) for cue in EVERY_CUE} == set(CUES.values())
    problem = Problem(Back.disc(30), [SEEING] * 2, [300.0], cues=EVERY_CUE)
    assert read_problem(through_json(problem_record(problem)), "problem").cues == EVERY_CUE


def test_a_cue_that_holds_nothing_is_a_word():
    problem = Problem(Back.disc(30), [SEEING] * 2, [300.0])
    assert problem_record(problem)["cues"] == ["pair_stereo", "lens_defocus"]


@pytest.mark.parametrize("metric", [metric() for metric in METRICS.values()], ids=list(METRICS))
def test_metric_fusion_guess_and_field_come_back(metric):
    given = {"metric": metric, "fusion": InverseVariance(), "guess": 700, "field": Field([0, 20], [2, 1])}
    problem = Problem(Back.disc(30), [SEEING] * 2, [300.0, 400.0], **given)
    again = read_problem(through_json(problem_record(problem)), "problem")
    assert {key: getattr(again, key) for key in given} == given


def test_what_was_not_asked_is_not_written():
    keys = ["back", "lenses", "depths", "weights", "cues", "gap"]
    assert list(problem_record(Problem(Back.disc(30), [SEEING], [300.0]))) == keys


def test_every_field_of_a_lens_is_written_once_it_is_known():
    known = Lens(
        5, (1, 2), (9, 99), position=(1, 2), field_of_view_deg=70, near_focus=8, sensor=SEEING.sensor, name="tele"
    )
    assert list(lens_record(known)) == [field.name for field in fields(Lens)]


def test_the_name_of_a_lens_comes_back():
    assert read_lens(through_json(lens_record(Lens(5, (1, 2), name="tele"))), "lens").name == "tele"


def test_the_nouns_of_a_file_are_the_same_text_however_often_they_are_read():
    problem = Problem(Back.disc(30), [SEEING] * 2, [300.0], cues=EVERY_CUE)
    written = json.dumps(problem_record(problem))
    assert json.dumps(problem_record(read_problem(json.loads(written), "problem"))) == written


@dataclass(frozen=True)
class Lidar(PairStereo):
    """A cue of somebody else's."""


def test_a_foreign_cue_is_not_saved():
    problem = Problem(Back.disc(30), [Lens(5, (1, 2))] * 2, [300.0], cues=[Lidar()])
    with pytest.raises(
        TypeError, match=r"^cues must be among pair_stereo, .* to be saved, got a Lidar, which is code$"
    ):
        problem_record(problem)


def test_a_score_of_ones_own_is_not_saved():
    with pytest.raises(TypeError, match=r"^problem must be a Problem to be saved, got a ScoreProblem"):
        problem_record(ScoreProblem(Back.disc(30), [Lens(5, (1, 2))], lambda layout: -layout.aperture_radius))


WORDS = ", ".join(CUES)


@pytest.fixture
def whole():
    problem = Problem(
        Back.rectangle(70, 150).keep_out("flash", disc((30, 10), 3)), [Lens(5, (1, 2), (200, 900))] * 2, [300.0, 400.0]
    )
    return through_json(problem_record(problem))


def spoiled(value, path, new):
    """The same data with another value at the end of a path; a new key if there was none."""
    if not path:
        return new
    key, *rest = path
    copy = dict(value) if isinstance(value, dict) else list(value)
    copy[key] = spoiled(value[key] if rest else None, rest, new)
    return copy


@pytest.mark.parametrize(
    ("path", "new", "message"),
    [
        (["cues", 0], "numpy.load", f"problem.cues[0] must be one of {WORDS}, got 'numpy.load'"),
        (["cues", 0], ["pair_stereo"], f"problem.cues[0] must be one of {WORDS}, got a list of 1"),
        (["cues", 0], {"name": "os.system"}, f"problem.cues[0].name must be one of {WORDS}, got 'os.system'"),
        (["cues", 0], "printed_defocus", "problem.cues[0] must have the keys frequency_error, amplitude_error, "),
        (
            ["cues", 0],
            {"name": "limited_stereo", "limits": {"least_overlap": 2.0}},
            "problem.cues[0].limits: least_overlap must be >= 0 and < 1, got 2",
        ),
        (
            ["cues", 0],
            {"name": "limited_stereo", "limits": {"least_overlap": 0.0}, "function": "os.system"},
            "problem.cues[0] must have the keys limits, got the unknown key 'function'",
        ),
        (
            ["lenses", 0, "sensor"],
            {"pixel_pitch_um": 1},
            "problem.lenses[0].sensor must have the keys pixel_pitch_um, ",
        ),
        (["metric"], "kindness", "problem.metric must be one of mean_square, "),
        (["fusion"], "cold", "problem.fusion must be one of best, "),
        (["guess"], "far", "problem.guess must be a number, got 'far'"),
        (["cues"], [], "problem: cues must give at least one measurement with these lenses, got none"),
        (["lenses", 1, "focal_length"], "5", "problem.lenses[1].focal_length must be a number, got '5'"),
        (["lenses", 1, "focal_length"], -5.0, "problem.lenses[1]: focal_length must be > 0 and finite, got -5"),
        (["lenses", 1, "tiers"], 1.5, "problem.lenses[1].tiers must be a whole number, got 1.5"),
        (["lenses", 1, "focus"], [1.0], "problem.lenses[1].focus must be a list of 2, got 1"),
        (["lenses", 1, "position"], [None, "x"], "problem.lenses[1].position[1] must be a number, got 'x'"),
        (["lenses"], [], "problem: lenses must be at least one, got none"),
        (["depths", 1], True, "problem.depths[1] must be a number, got True"),
        (["weights"], [1.0], "problem: weights must be 2 finite numbers >= 0, not all 0, one for each depth"),
        (["gap"], -1.0, "problem: gap must be >= 0 mm and finite, got -1"),
        (["back", "outline", "core"], "os.system", "problem.back.outline.core must be one of Polygon, MultiPolygon, "),
        (["back", "outline", "coordinates", 0, 1, 0], 1e300, "problem.back.outline.coordinates[0]: point 1 must be "),
        (
            ["back", "outline", "coordinates", 0],
            [[0.0, 0.0]],
            "problem.back.outline.coordinates[0] must be at least 3 ",
        ),
        (
            ["back", "outline", "coordinates"],
            [],
            "problem.back.outline.coordinates must be at least one ring, got none",
        ),
        (
            ["back", "outline", "coordinates"],
            [[[0.0, 0.0], [9.0, 9.0], [9.0, 0.0], [0.0, 9.0]]],
            "problem.back.outline: shape must not cross itself",
        ),
        (["back", "keep_outs", 0, "name"], 7, "problem.back.keep_outs[0].name must be a text, got 7"),
        (
            ["back", "keep_outs", 0, "clearance"],
            -1.0,
            "problem.back.keep_outs[0]: clearance of keep-out flash must be ",
        ),
        (
            ["back", "_target_"],
            "numpy.load",
            "problem.back must have the keys outline, keep_outs, got the unknown key ",
        ),
    ],
)
def test_what_is_wrong_with_a_problem_is_named_in_one_line(whole, path, new, message):
    with pytest.raises(ValueError, match="problem") as refusal:
        read_problem(spoiled(whole, path, new), "problem")
    assert str(refusal.value).startswith(message)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda problem: problem["lenses"][0].update(tiers=10**12),
        lambda problem: problem.update(lenses=problem["lenses"] * 250, depths=[300.0] * 50, weights=[1.0] * 50),
    ],
    ids=["tiers", "pairs"],
)
def test_a_small_file_cannot_ask_for_all_memory(whole, spoil):
    spoil(whole)
    with pytest.raises(ValueError, match=r"^problem must have at most 1e\+07 pairs and tiers times depths, got "):
        read_problem(whole, "problem")


ROBUST = Robust(
    Problem(Back.disc(10), [Lens(6.0, (0.5, 2.0))] * 2, [500.0, 900.0]),
    Disturbance(0.1, 0.02, 0.3, Drift(0.01, 0.1, 0.002)),
    level=0.9,
    samples=4,
    seed=7,
)


def test_a_question_of_many_devices_comes_back_with_the_same_devices():
    back = read_problem(through_json(problem_record(ROBUST)), "problem")
    assert isinstance(back, Robust)
    assert (back.disturbance, back.level, back.samples, back.seed) == (ROBUST.disturbance, 0.9, 4, 7)
    assert back.devices.shift.tolist() == ROBUST.devices.shift.tolist()
    assert problem_record(back) == problem_record(ROBUST)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("samples", 10**9, "problem.robust.samples must be from 2 to 4096, got 1000000000"),
        ("samples", 3, "problem.robust: samples must be an even number >= 2, got 3"),
        ("level", 2.0, "problem.robust: level must be from 0 to 1, got 2"),
        ("disturbance", {"shift": 0.1}, "problem.robust.disturbance .*focus_dioptre"),
    ],
)
def test_devices_that_make_no_sense_are_refused_with_their_key(key: str, value: object, message: str):
    changed = through_json(problem_record(ROBUST))
    changed["robust"][key] = value
    with pytest.raises(ValueError, match=message):
        read_problem(changed, "problem")
