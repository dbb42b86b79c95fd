"""Devices that are not as drawn, from a configuration: what comes out, and what is refused."""

from pathlib import Path
from typing import Any

import pytest

from multilens import Back, Disturbance, Drift, Lens, PairStereo, Problem, Robust
from multilens.app.command import run_command
from multilens.app.refusal import RefusedError
from multilens.app.robust import build_robust, check_robust
from multilens.app.schema import DriftConfig, RobustConfig

LENS = Lens(6.0, (0.5, 2.0))
PROBLEM = Problem(Back.disc(20), [LENS] * 3, [500.0, 1000.0])


def test_nothing_that_sets_devices_apart_leaves_the_problem():
    assert build_robust(RobustConfig(level=0.5), PROBLEM) is PROBLEM


def test_every_number_arrives_in_its_place():
    config = RobustConfig(0.1, 0.02, 0.3, DriftConfig(0.04, 0.5, 0.06), level=0.7, samples=8, seed=9)
    robust = build_robust(config, PROBLEM)
    assert isinstance(robust, Robust)
    assert robust.disturbance == Disturbance(0.1, 0.02, 0.3, Drift(0.04, 0.5, 0.06))
    assert (robust.level, robust.samples, robust.seed) == (0.7, 8, 9)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"shift": -1.0}, "robust.shift must be >= 0 mm and finite, got -1"),
        ({"focus_dioptre": float("nan")}, "robust.focus_dioptre must be >= 0 dioptres and finite, got nan"),
        ({"drift": DriftConfig(decentre_um=-2.0)}, "robust.drift.decentre_um must be >= 0 um and finite, got -2"),
        ({"covered": 1.5}, "robust.covered must be from 0 to 1, got 1.5"),
        ({"level": -0.1}, "robust.level must be from 0 to 1, got -0.1"),
        ({"samples": 7}, "robust.samples must be an even number from 2 to 4096, got 7"),
        ({"seed": -1}, "robust.seed must be from 0 to 2147483647, got -1"),
    ],
)
def test_what_is_out_of_range_is_refused(given: dict[str, Any], message: str):
    with pytest.raises(RefusedError, match=message):
        check_robust(RobustConfig(**given))


def test_a_lens_that_nothing_can_do_without_is_told_with_its_key():
    pair = Problem(Back.disc(20), [LENS] * 2, [500.0], cues=[PairStereo()])
    with pytest.raises(RefusedError, match="robust: lens 1 cannot be covered: without it nothing measures"):
        build_robust(RobustConfig(covered=1.0), pair)


def test_a_device_is_evaluated_under_its_disturbance(capsys: pytest.CaptureFixture[str]):
    words = ["experiment=devices/iphone_13_pro", "robust=finger", "depth.count=16"]
    assert run_command(["evaluate", *words]) == 0
    said = capsys.readouterr().out
    assert "RMSE of the worst device" in said
    assert "if one lens is off" in said


def test_a_saved_design_is_scored_under_another_disturbance(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    run = tmp_path / "run"
    words = ["experiment=demo", "depth.count=24", "search=quick", "search.starts=2", "robust=focus", "search.proof=0"]
    words.append(f"hydra.run.dir={run}")
    monkeypatch.setattr("sys.argv", ["multilens", *words])
    monkeypatch.setattr("multilens.runs._draw", lambda design, folder: None)
    assert run_command(words) == 0
    assert "RMSE over devices" in capsys.readouterr().out
    assert run_command(["evaluate", str(run), "robust=finger"]) == 0
    assert "RMSE of the worst device" in capsys.readouterr().out
    assert run_command(["evaluate", str(run), "depth.far=2000", "depth.count=24"]) == 0
    assert "RMSE over devices" in capsys.readouterr().out
