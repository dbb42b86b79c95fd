import json
from dataclasses import dataclass
from math import cos, pi, sin

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, MultiPolygon, Polygon

from multilens.back import Back
from multilens.certificate import Certificate, Clearance
from multilens.convergence import Convergence
from multilens.cues import CUES, LensDefocus, PairStereo
from multilens.depths import log_depths
from multilens.geometry.shape import Shape, disc, polygon
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem
from multilens.records import (
    back_record,
    certificate_record,
    convergence_record,
    layout_record,
    lens_record,
    origin_record,
    problem_record,
    read_back,
    read_certificate,
    read_convergence,
    read_layout,
    read_lens,
    read_origin,
    read_problem,
    read_shape,
    shape_record,
)
from multilens.score_problem import ScoreProblem
from multilens.storage import Origin


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
    )


@st.composite
def stars(draw, middle=(0.0, 0.0)):
    """A polygon seen whole from its middle: never crosses itself, of any outline."""
    radii = draw(st.lists(st.floats(5.0, 10.0), min_size=3, max_size=12))
    x, y = middle
    return [
        (x + radius * cos(2 * pi * k / len(radii)), y + radius * sin(2 * pi * k / len(radii)))
        for k, radius in enumerate(radii)
    ]


@st.composite
def layouts(draw, given_lenses):
    most = max(lens.tiers for lens in given_lenses)
    foci = [draw(st.lists(lengths, min_size=lens.tiers, max_size=lens.tiers)) for lens in given_lenses]
    return Layout(
        [[draw(coordinates), draw(coordinates)] for _ in given_lenses],
        [draw(lengths) for _ in given_lenses],
        [own + own[:1] * (most - len(own)) for own in foci],
    )


@given(lenses())
def test_a_lens_comes_back(lens):
    assert read_lens(through_json(lens_record(lens)), "lens") == lens


@given(stars(), st.booleans())
def test_a_polygon_comes_back_to_the_bit(points, with_hole):
    hole = [[(1.0, 1.0), (1.0, 0.1), (0.3, 1.0)]] if with_hole else []
    shape = Shape(Polygon(points, hole))
    back = read_shape(through_json(shape_record(shape)), "outline")
    assert back.core.equals_exact(shape.core)
    assert back.segments.tobytes() == shape.segments.tobytes()


@pytest.mark.parametrize(
    "shape",
    [
        disc((0.1, -0.2), 0.3),
        Shape(LineString([(0.1, 0.2), (0.7, 0.2), (0.7, 0.9)]), 0.1),
        Shape(MultiPolygon([Polygon([(0, 0), (0, 1), (1, 0)]), Polygon([(5, 5), (5, 6.1), (6, 5)])])),
        Shape(Polygon([(0, 0), (0, 1), (1, 1), (1, 0)]), 0.25),
    ],
    ids=["point", "line", "parts", "rounded"],
)
def test_every_kind_of_core_comes_back(shape):
    back = read_shape(through_json(shape_record(shape)), "outline")
    assert back.radius == shape.radius
    assert back.core.geom_type == shape.core.geom_type
    assert back.segments.tobytes() == shape.segments.tobytes()


def test_keep_outs_come_back_with_their_names_and_clearances():
    back = Back.rounded_rectangle(70, 150, 13).keep_out("micrófono", disc((30, 10), 3), 0.5)
    back = back.keep_out("logo", polygon([(20, 70), (30, 70), (25, 80)]))
    again = read_back(through_json(back_record(back)), "back")
    assert [(k.name, k.clearance) for k in again.keep_outs] == [("micrófono", 0.5), ("logo", 0.0)]
    assert back_record(again) == back_record(back)


@given(st.data())
def test_a_layout_comes_back_to_the_bit(data):
    given_lenses = data.draw(st.lists(lenses(), min_size=1, max_size=5))
    layout = data.draw(layouts(given_lenses))
    again = read_layout(through_json(layout_record(layout, given_lenses)), "layout", given_lenses)
    for name in ("position", "aperture_radius", "focus"):
        before, after = getattr(layout, name), getattr(again, name)
        assert before.dtype == after.dtype
        assert before.numpy().tobytes() == after.numpy().tobytes()


def test_a_lens_of_fewer_tiers_stores_its_own_foci_alone():
    two = [Lens(5, (1, 2)), Lens(5, (1, 2), tiers=2)]
    rows = layout_record(Layout([[0, 0], [9, 0]], [1, 1], [[300, 300], [400, 500]]), two)
    assert [row["focus"] for row in rows] == [[300.0], [400.0, 500.0]]


@pytest.mark.parametrize(
    ("layout", "message"),
    [
        (Layout([[[0, 0]]], [[1]], [[300]]), r"^layout must be a single one, got a batch of the shape \[1\]$"),
        (Layout([[0, 0], [9, 0]], [1, 1], [300, 300]), "^layout must have 1 lenses, got 2$"),
        (Layout([[0, 0]], [1], [300]), "^focus must have a place for 2 tiers, got 1$"),
    ],
)
def test_a_layout_of_another_form_is_refused(layout, message):
    with pytest.raises(ValueError, match=message):
        layout_record(layout, [Lens(5, (1, 2), tiers=2)])


weights = st.lists(st.floats(0, 1e6), min_size=2, max_size=40).filter(lambda all_of_them: sum(all_of_them) > 1e-6)


@given(weights)
def test_a_problem_comes_back_to_the_bit(given_weights):
    depths = log_depths(200, 5000, len(given_weights))
    problem = Problem(Back.disc(30), [Lens(5, (1, 2))] * 2, depths, given_weights, [LensDefocus(), PairStereo()], 0.1)
    again = read_problem(through_json(problem_record(problem)), "problem")
    assert again.weights.numpy().tobytes() == problem.weights.numpy().tobytes()
    assert again.depths.numpy().tobytes() == problem.depths.numpy().tobytes()
    assert (again.lenses, again.cues, again.gap) == (problem.lenses, problem.cues, problem.gap)


def test_every_cue_of_the_table_comes_back():
    problem = Problem(Back.disc(30), [Lens(5, (1, 2))] * 2, [300.0], cues=[cue() for cue in CUES.values()])
    assert [type(cue) for cue in read_problem(problem_record(problem), "problem").cues] == list(CUES.values())


@dataclass(frozen=True)
class Lidar(PairStereo):
    """A cue of somebody else's."""


def test_a_foreign_cue_is_not_saved():
    problem = Problem(Back.disc(30), [Lens(5, (1, 2))] * 2, [300.0], cues=[Lidar()])
    with pytest.raises(TypeError, match=r"^cues must be among pair_stereo, lens_defocus to be saved, got a Lidar"):
        problem_record(problem)


def test_a_score_of_ones_own_is_not_saved():
    with pytest.raises(TypeError, match=r"^problem must be a Problem to be saved, got a ScoreProblem"):
        problem_record(ScoreProblem(Back.disc(30), [Lens(5, (1, 2))], lambda layout: -layout.aperture_radius))


def test_a_certificate_comes_back():
    certificate = Certificate((Clearance("lens 1 to flash", 0.1 + 0.2, True), Clearance("lens 1", -1e-300, False)))
    assert read_certificate(through_json(certificate_record(certificate)), "certificate") == certificate


def test_an_origin_comes_back():
    origin = Origin(2**70, 256, 24, "distance_penalty", 0.1, {"torch": "2.13.0+cpu", "python": "3.11.9"}, "abc+")
    assert read_origin(through_json(origin_record(origin)), "origin") == origin
    assert read_origin(through_json(origin_record(Origin(0, 1, 1, "p", None))), "origin") == Origin(0, 1, 1, "p", None)


def test_a_history_is_kept_to_six_digits():
    scores = torch.tensor([[1.23456789e10, torch.nan], [-0.000123456789, torch.inf]], dtype=torch.float64)
    convergence = Convergence((0, 20), scores, (1, 0), (1 / 3, torch.nan))
    record = through_json(convergence_record(convergence))
    assert record["scores"] == [[12345700000.0, None], [-0.000123457, None]]
    again = read_convergence(record, "convergence")
    assert (again.steps, again.polished) == ((0, 20), (1, 0))
    assert again.scores.isnan().tolist() == [[False, True], [False, True]]
    assert again.polished_scores[0] == 1 / 3
    assert again.polished_scores[1] != again.polished_scores[1]


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
        (["cues", 0], "numpy.load", "problem.cues[0] must be one of pair_stereo, lens_defocus, got 'numpy.load'"),
        (["cues", 0], ["pair_stereo"], "problem.cues[0] must be one of pair_stereo, lens_defocus, got a list of 1"),
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


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        ({"scores": [[1.0]]}, "c.scores[0] must be a list of 2, got 1"),
        ({"polished": [3]}, "c.polished must name starts from 0 to 0, got 3"),
        ({"polished_scores": [1.0, 2.0]}, "c.polished_scores must be at most 1, got 2"),
        ({"steps": [0, 1.5]}, "c.steps[1] must be a whole number, got 1.5"),
    ],
)
def test_a_history_that_does_not_fit_together_is_refused(spoil, message):
    fine = {"steps": [0, 20], "polished": [0], "polished_scores": [1.0], "scores": [[2.0, None]]}
    with pytest.raises(ValueError, match="c") as refusal:
        read_convergence(fine | spoil, "c")
    assert str(refusal.value) == message
