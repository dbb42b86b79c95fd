import json
from dataclasses import replace
from hashlib import sha256

import pytest
import torch

from multilens.back import Back
from multilens.certificate import Certificate, Clearance, certify
from multilens.convergence import Convergence
from multilens.cues import LimitedStereo, PairLimits, PairStereo
from multilens.depths import log_depths
from multilens.design import INFEASIBLE, Design
from multilens.geometry.shape import disc
from multilens.layout import Layout
from multilens.lens import Lens
from multilens.problem import Problem
from multilens.score_problem import ScoreProblem
from multilens.search.solve import solve
from multilens.storage import Origin
from multilens.tolerance import Tolerance


def by_hand(problem, layout, **others):
    certificate = certify(problem.back, problem.lenses, problem.focus_range, layout, problem.gap)
    return Design(problem, layout, "complete", "", certificate, **others)


@pytest.fixture(scope="module")
def problem():
    lens = Lens(5.0, (0.5, 2.0), clearance=1.0)
    back = Back.rounded_rectangle(70, 150, 13).keep_out("flash", disc((35, 30), 3), 0.5)
    return Problem(back, [lens, replace(lens, tiers=2)], log_depths(200, 5000, 16), gap=0.1)


@pytest.fixture(scope="module")
def design(problem):
    layout = Layout([[20.1, 30.2], [50.3, 70.2]], [1.1, 2.0], [[300.3, 300.3], [900.9, 2000.1]])
    scores = torch.tensor([[3.5, 2.25], [torch.nan, torch.nan]], dtype=torch.float64)
    origin = Origin(7, 2, 1, "distance_penalty", None, {"python": "3.11"}, "abc")
    return by_hand(problem, layout, convergence=Convergence((0, 20), scores, (0,), (2.0,)), origin=origin)


@pytest.fixture
def saved(design, tmp_path):
    design.save(tmp_path / "design.json")
    return tmp_path / "design.json"


def tensors(design):
    layout = design.layout
    return [t.numpy().tobytes() for t in (layout.position, layout.aperture_radius, layout.focus)]


def test_a_design_comes_back_to_the_bit(design, saved):
    again = Design.load(saved)
    assert tensors(again) == tensors(design)
    assert (again.score, again.rmse, again.status, again.reason) == (design.score, design.rmse, "complete", "")
    assert again.certificate == design.certificate
    assert again.origin == design.origin
    assert again.problem.lenses == design.problem.lenses


def test_a_design_that_came_back_is_saved_as_the_same_bytes(saved, tmp_path):
    Design.load(saved).save(tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == saved.read_bytes()


def test_the_same_search_is_saved_as_the_same_bytes(problem):
    first, second = (solve(problem, starts=4, seed=3, patience=0).to_json() for _ in range(2))
    assert first == second


def test_a_design_by_hand_needs_neither_origin_nor_convergence(design, tmp_path):
    replace(design, origin=None, convergence=None).save(tmp_path / "design.json")
    again = Design.load(tmp_path / "design.json")
    assert (again.origin, again.convergence) == (None, None)


def test_the_stored_score_is_that_of_the_formula(design, saved):
    # By hand: stereo err = Z^2 / (b f), defocus err = Z |Z - Zf| / (2 A f), the least of all at each depth.
    baseline = (30.2**2 + 40.0**2) ** 0.5
    foci = [(1.1, 300.3), (2.0, 900.9), (2.0, 2000.1)]
    depths = [200 * 25 ** (k / 15) for k in range(16)]
    least = [min(z * z / (5 * baseline), *(z * abs(z - zf) / (2 * a * 5) for a, zf in foci)) for z in depths]
    score = sum(error**2 for error in least) / 16
    assert json.loads(saved.read_text())["score"] == pytest.approx(score, rel=1e-12)


def test_an_infeasible_design_is_not_saved(design, tmp_path):
    infeasible = replace(design, status=INFEASIBLE, reason="no room for lens 2")
    with pytest.raises(ValueError, match=r"^design must be feasible to be saved: no room for lens 2$"):
        infeasible.save(tmp_path / "design.json")
    assert not list(tmp_path.iterdir())


def test_a_design_that_claims_to_be_feasible_is_not_saved(design, tmp_path):
    overlapping = Layout([[20.0, 30.0], [21.0, 30.0]], [1.0, 1.0], design.layout.focus)
    with pytest.raises(ValueError, match=r"^layout must be feasible, got lens 1 to lens 2 lacking 3\.1 mm$"):
        replace(design, layout=overlapping).save(tmp_path / "design.json")
    assert not list(tmp_path.iterdir())


def test_a_certificate_of_another_layout_is_not_saved(design, tmp_path):
    with pytest.raises(ValueError, match=r"^certificate must be the layout's"):
        replace(design, certificate=Certificate((Clearance("all", 1.0, True),))).save(tmp_path / "design.json")


def test_a_score_of_ones_own_is_not_saved(problem, design, tmp_path):
    own = ScoreProblem(problem.back, problem.lenses, lambda layout: -layout.aperture_radius)
    with pytest.raises(TypeError, match="whose score is code"):
        replace(design, problem=own).save(tmp_path / "design.json")
    assert not list(tmp_path.iterdir())


def resealed(text, change):
    """The document after a change, with a checksum that fits: what only reading with care finds out."""
    content = json.loads(text)
    del content["checksum"]
    change(content)
    canonical = json.dumps(content, sort_keys=True, separators=(",", ":"))
    return json.dumps(content | {"checksum": "sha256:" + sha256(canonical.encode()).hexdigest()})


def set_at(*path_and_value):
    *path, key, value = path_and_value

    def change(content):
        for step in path:
            content = content[step]
        content[key] = value

    return change


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (set_at("schema_version", 3), "schema_version must be 2, got 3"),
        (set_at("score", 1.0), "score must be the layout's, "),
        (set_at("rmse", 1.0), "rmse must be the layout's, "),
        (set_at("status", "infeasible"), "status must be one of complete, time limit, as given, got 'infeasible'"),
        (set_at("units", "length", "m"), "units must be {'length': 'mm'"),
        (set_at("layout", 0, "aperture_radius", 2.5), "layout must be feasible, got aperture of lens 1 lacking 0.5 mm"),
        (set_at("layout", 0, "position", [35.0, 30.0]), "layout must be feasible, got lens 1 to flash lacking "),
        (set_at("layout", 0, "position", [35.0, None]), "layout[0].position[1] must be a number, got None"),
        (set_at("layout", []), "layout must be a list of 2, got 0"),
        (set_at("certificate", 0, "room", 9.0), "certificate[0].room must be the layout's, "),
        (set_at("certificate", []), "certificate must be the layout's, got other clearances"),
        (set_at("problem", "lenses", 0, "_target_", "os.system"), "problem.lenses[0] must have the keys "),
        (set_at("extra", 1), "design must have the keys units, "),
        (set_at("origin", "versions", "torch", 2), "origin.versions.torch must be a text, got 2"),
        (set_at("convergence", "scores", 0, 0, "x"), "convergence.scores[0][0] must be a number, got 'x'"),
    ],
)
def test_what_does_not_hold_is_refused_in_one_line_that_names_the_file(saved, change, message):
    saved.write_text(resealed(saved.read_text(), change))
    with pytest.raises(ValueError, match="must") as refusal:
        Design.load(saved)
    assert str(refusal.value).startswith(f"{saved}: {message}")
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("most", [0.05, 0.03], ids=["one depth of three", "none"])
def test_a_share_that_another_machine_rounds_otherwise_is_read(most):
    # Pairs fail nearer than b f / most = 15 / most = 300 or 500 mm. A share is 1 less what fails: it is rounded as 1 is.
    cues = [LimitedStereo(PairLimits(max_disparity=most))]
    problem = Problem(Back.rectangle(70, 150), [Lens(5.0, (1.0, 1.0))] * 2, [200, 250, 350], [1, 1, 1e-9], cues)
    design = by_hand(problem, Layout([[10.0, 10.0], [13.0, 10.0]], [1.0, 1.0], [[300.0], [300.0]]))
    rounded = resealed(design.to_json(), set_at("measured", design.measured + 2**-52))
    assert Design.from_json(rounded).measured == design.measured


def test_a_printed_design_tells_the_guess_where_nothing_measures():
    # 20 mm at a parallax of at most 0.05 mm behind 5 mm measure from 2000 mm on: one of two depths that spread by 900 mm.
    lens, cue = Lens(5, (1, 1), (200, 5000), disparity_noise=1e-3), LimitedStereo(PairLimits(max_disparity=0.05))
    half = Problem(Back.rectangle(40, 10), [lens] * 2, [1200.0, 3000.0], cues=[cue])
    told = str(by_hand(half, Layout([(10, 5), (30, 5)], [1, 1], [1000, 1000])))
    assert "50 % of the depths; the error of the others is a guess, 900 mm" in told


def test_a_truncated_file_is_refused(saved):
    saved.write_bytes(saved.read_bytes()[:-100])
    with pytest.raises(ValueError, match=r"design\.json: must be whole JSON, got "):
        Design.load(saved)


def test_an_altered_file_is_refused(saved):
    text = saved.read_text()
    saved.write_text(text.replace('"gap": 0.1', '"gap": 0.2'))
    with pytest.raises(ValueError, match=r"design\.json: checksum must be "):
        Design.load(saved)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"nothing\.json"):
        Design.load(tmp_path / "nothing.json")


def test_a_printed_design_is_a_table(design):
    # Longest baseline sqrt(30.2^2 + 40^2); lens 1 to flash sqrt(14.9^2 + 0.2^2) - 1.1 - 1 - 3 - 0.5 = 9.3. That aperture 2.0
    # stands at its bound is no clearance.
    assert str(design).splitlines() == [
        "lens  x (mm)  y (mm)  aperture radius (mm)  f-number     focus (mm)",
        "   1  20.100  30.200                 1.100      2.27          300.3",
        "   2  50.300  70.200                 2.000      1.25  900.9, 2000.1",
        "",
        "status              complete",
        f"RMSE                {design.score**0.5:.6g} mm",
        "longest baseline    50.120 mm, lens 1 to lens 2",
        "tightest clearance  9.3 mm, lens 1 to flash",
    ]


def test_a_broken_clearance_is_told_by_what_it_lacks():
    lenses = [Lens(1.0, (0.5, 2.0))] * 2
    lines = str(
        by_hand(Problem(Back.disc(9.0), lenses, [5.0]), Layout([[0.0, 0.0], [1.0, 0.0]], [1.5, 1.5], [5.0, 5.0]))
    )
    assert lines.splitlines()[-1] == "tightest clearance  lacks 2 mm, lens 1 to lens 2"


def test_a_printed_infeasible_design_is_its_reason(design):
    assert str(replace(design, status=INFEASIBLE, reason="no room")) == "infeasible: no room"


def test_a_printed_score_of_ones_own_has_no_unit():
    own = ScoreProblem(Back.disc(2.0), [Lens(1.0, (0.5, 2.0))], lambda layout: -layout.aperture_radius)
    lines = str(by_hand(own, Layout([[0.0, 0.0]], [1.5], [[1.0]]))).splitlines()
    assert lines[-2:] == ["score               -1.5", "tightest clearance  0.5 mm, lens 1 within outline"]


def test_a_design_tells_where_it_works():
    # Stereo alone, Z^2 n / (b f) = 10 mm, across the diagonal of what is left to the centres, 30 x 2 mm.
    lens = Lens(5.0, (1.0, 1.0), disparity_noise=1e-3)
    problem = Problem(Back.rectangle(32, 4), [lens] * 2, log_depths(200, 3000, 50), cues=[PairStereo()])
    design = solve(problem, starts=2, patience=0, proof=0)
    (found,) = design.working_range(Tolerance(mm=10)).intervals
    assert found == pytest.approx((200, (10 * (30**2 + 2**2) ** 0.5 * 5 / 1e-3) ** 0.5), rel=1e-6)


def test_the_working_range_is_printed_when_a_tolerance_is_asked_for(design):
    assert "working range" not in str(design)
    asked = replace(design, tolerance=Tolerance(mm=10, percent=1))
    (line,) = (line for line in str(asked).splitlines() if line.startswith("working range"))
    assert line.endswith(str(asked.working_range(asked.tolerance)))


def test_a_tolerance_is_saved_and_read_back(design):
    asked = replace(design, tolerance=Tolerance(mm=10, percent=1))
    assert Design.from_json(asked.to_json()).tolerance == asked.tolerance
    assert Design.from_json(design.to_json()).tolerance is None
