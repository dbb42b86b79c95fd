"""The study's result still holds: its stored tables against oracles that are not its code."""

import csv
import sys
from collections.abc import Iterator
from importlib.util import module_from_spec, spec_from_file_location
from itertools import pairwise
from pathlib import Path
from types import ModuleType

import pytest
import torch

import multilens as ml

STUDY = Path(__file__).parent

SWITCHING_RATIO = {20: 5.11, 30: 5.34, 80: 9.32, 100: 6.07, 300: 7.66}
"""By nearest depth, from an independent exhaustive search, known to 0.02."""


def load(name: str) -> ModuleType:
    spec = spec_from_file_location(f"thesis_two_lens_{name}", STUDY / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


model, line, solver = load("model"), load("line"), load("solver")


@pytest.fixture(autouse=True)
def _one_thread() -> Iterator[None]:
    """The tensors are small: on a busy machine, waiting for a second thread takes a hundred times longer than the work."""
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(threads)


def stored(name: str) -> list[dict[str, str]]:
    with (STUDY / "results" / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def thesis_loss(row: dict[str, str], f_dfdd: float = 50.0, count: int = 200) -> float:
    """The formula of chapter 6 with plain numbers, one depth after the other."""
    near, far, ratio = float(row["near"]), float(row["far"]), float(row["ratio"])
    gap, diameter, focus = (float(row[key]) for key in ("gap", "aperture_diameter", "focus"))
    penalty = max(0.0, abs(gap + 2 + diameter - 50))
    total = 0.0
    for step in range(count):
        z = near + (far - near) * step / (count - 1)
        stereo = z * z / (max(gap, 1e-6) * ratio * f_dfdd)
        total += (min(stereo, z * abs(z - focus) / (diameter * f_dfdd)) + penalty) ** 2
    return total / count


def test_stored_losses_are_those_of_the_thesis_formula():
    for row in stored("table"):
        # Stored lengths are rounded to a millionth of a millimetre, which the penalty sees.
        assert float(row["loss"]) == pytest.approx(thesis_loss(row), rel=3e-5), row


@pytest.mark.parametrize("near", SWITCHING_RATIO)
def test_stored_switching_ratios_are_the_independent_ones(near: int):
    (row,) = [
        row for row in stored("switching") if (row["near"], row["far"] != "500" or near == 300) == (str(near), True)
    ]
    assert float(row["switch_gap"]) == pytest.approx(SWITCHING_RATIO[near], abs=0.02)


def test_the_code_still_finds_a_stored_switching_ratio():
    assert line.switching_ratio(ml.linear_depths(80, 120, 200)) == pytest.approx(SWITCHING_RATIO[80], abs=0.02)


def test_only_far_over_near_decides():
    ratios = [line.switching_ratio(ml.linear_depths(near, 2 * near, 50)) for near in (10, 1000)]
    assert ratios[0] == pytest.approx(ratios[1], abs=1e-3)


@pytest.mark.parametrize("ratio", [1.0, 5.0, 6.0, 9.0, 30.0])
@pytest.mark.parametrize(("near", "far"), [(20, 50), (80, 120)])
def test_no_arrangement_between_the_extremes_is_best(near: int, far: int, ratio: float):
    z = torch.linspace(near, far, 60, dtype=torch.float64)
    gap = torch.linspace(0, 46, 24, dtype=torch.float64).clamp(min=1e-6)[:, None, None]
    focus = torch.linspace(near, far, 60, dtype=torch.float64)[:, None]
    cost = torch.minimum(z**2 / (gap * ratio), z * (z - focus).abs() / (48 - gap)).square().mean(-1).amin(-1)
    assert cost.argmin().item() in (0, len(gap) - 1)


def test_exhaustive_defocus_optimum_is_the_closed_form():
    z = torch.linspace(300, 500, 200, dtype=torch.float64)
    best = line.least_loss(line.EXTREMES, z, 6.0)
    assert best.loss[0] < best.loss[1]
    assert best.focus[0].item() == pytest.approx((z**3).sum().item() / (z**2).sum().item(), rel=1e-12)


def test_stored_exhaustive_and_multilens_agree():
    for name in ("table", "centres"):
        for exhaustive, solved in pairwise(stored(name)):
            if exhaustive["what"] == "exhaustive":
                assert solved["what"] == "multilens"
                assert float(solved["of_optimum"]) == pytest.approx(1, abs=1e-6), solved


def test_solve_still_finds_the_stored_optimum():
    (row,) = [row for row in stored("table") if (row["near"], row["ratio"], row["what"]) == ("80", "6.0", "exhaustive")]
    problem = solver.line_problem(ml.linear_depths(80, 120, 200), 6.0, solver.GapStereo(), 50.0)
    design = ml.solve(problem, starts=8, seed=0, patience=0)
    assert design.score == pytest.approx(float(row["loss"]), rel=1e-6)


def test_cues_of_the_study_score_as_the_port_does():
    depths = ml.linear_depths(30, 70, 40)
    lenses = model.Arrangement(*(torch.tensor(value).double() for value in (11.75, 53.0, 18.125)))
    layout = ml.Layout([[1.0, 25.0], [31.875, 25.0]], [1.0, 18.125], [53.0, 53.0])
    problem = solver.line_problem(depths, 3.0, solver.GapStereo(), 50.0)
    assert problem.score(layout).item() == pytest.approx(model.loss(lenses, depths, 150.0, 50.0).item(), rel=1e-12)


def test_gradient_flows_through_the_winner_alone():
    theta = torch.tensor([1e-3, 0.5, 0.998], dtype=torch.float64, requires_grad=True)
    depths = ml.linear_depths(300, 500, 50)
    lenses = model.arrangement(theta, depths)
    best = torch.minimum(model.stereo_error(lenses, depths, 50.0), model.defocus_error(lenses, depths, 50.0))
    (gradient,) = torch.autograd.grad(best.square().mean(), theta)
    assert gradient[0] == 0  # at this gap stereo wins nowhere
    assert gradient[2] < 0


def test_starts_are_drawn_from_the_stated_ranges_by_seed():
    theta = model.initial_thetas(200)
    low, high = torch.tensor([0.01, 0.3, 0.01]), torch.tensor([0.1, 0.9, 0.1])
    assert ((theta >= low) & (theta <= high)).all()
    assert theta[:5].equal(model.initial_thetas(5))


def test_descent_at_equal_focal_lengths_drains_the_gap_in_the_order_of_the_printed_rows():
    rows = [row for row in stored("table") if (row["ratio"], row["what"]) == ("1.0", "descent, median of 20")]
    gaps = [round(float(row["gap"]), 1) for row in rows]
    assert gaps == sorted(gaps, reverse=True)
    assert gaps[0] < 46 - 20  # and not the first printed row


def test_descent_comes_to_the_line_and_stays_on_it():
    depths = torch.stack([ml.linear_depths(100, 200, 50)])
    theta = model.initial_thetas(1)
    settings = model.GradientDescent(400, 8e-5, fading=True)
    *_, end = model.iterates(theta, depths, 50.0, 50.0, settings)
    first = model.loss(model.arrangement(theta, depths), depths, 50.0, 50.0)
    last = model.loss(model.arrangement(end, depths), depths, 50.0, 50.0)
    assert last < first / 50
    assert model.arrangement(end, depths).length_used.item() == pytest.approx(50, abs=0.02)
