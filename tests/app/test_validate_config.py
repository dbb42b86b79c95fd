"""What can be said of a configuration without a search."""

import json
from pathlib import Path

import pytest

from multilens.app.command import run_command

DEMO = ["validate-config", "experiment=demo"]


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    def search(*given: object, **named: object) -> None:
        raise AssertionError("nothing must be searched for")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("multilens.search.solve.solve", search)
    return tmp_path


def test_what_can_be_run_is_told(elsewhere: Path, capsys: pytest.CaptureFixture[str]):
    assert run_command([*DEMO, "lenses.count=3", "depth=portrait"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("OK: demo, 3 lenses; 512 depths from 300 to 1500 mm; cues stereo, defocus; ")
    assert (out.count("\n"), err) == (1, "")
    assert list(elsewhere.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        (["lenses.cuont=3"], 2, "did you mean lenses.count?"),
        (["depth.near=-5"], 2, "depth.near must be > 0 mm"),
        (["lenses.count=2,3"], 2, "several values need multilens -m"),
        (["lenses=null"], 2, "lenses=null: expected one of"),
        (["hydra/launcher=null"], 2, "hydra/launcher=null: must be the name of an option, got null"),
        (["lenses@lenses=null"], 2, "got null"),
        (["--cfg", "job"], 2, "--cfg is no flag of validate-config"),
        # What only building with torch finds: photometric cues need a sensor.
        (["cues=photometric", "lenses=unit"], 2, "sensor"),
        (["lenses.lens.clearance=40"], 3, "lens 1 needs a disc of radius 40.31 mm"),
        (["-m", "lenses.count=2,40", "lenses.lens.clearance=12"], 3, "lenses.count=40"),
    ],
)
def test_what_cannot_be_run_is_refused_in_one_line(
    words: list[str], code: int, told: str, elsewhere: Path, capsys: pytest.CaptureFixture[str]
):
    assert run_command([*DEMO, *words]) == code
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert told in err
    assert list(elsewhere.iterdir()) == []


def test_a_folder_that_is_used_is_refused(elsewhere: Path, capsys: pytest.CaptureFixture[str]):
    (elsewhere / "used").mkdir()
    (elsewhere / "used" / "kept.txt").touch()
    assert run_command([*DEMO, "hydra.run.dir=used"]) == 2
    assert "hydra.run.dir" in capsys.readouterr().err


def test_of_a_sweep_every_value_is_looked_at(capsys: pytest.CaptureFixture[str]):
    assert run_command([*DEMO, "-m", "lenses.count=2,3", "depth=portrait,room"]) == 0
    first, *jobs = capsys.readouterr().out.splitlines()
    assert first == "OK: a sweep of lenses.count, depth; looked at were"
    assert [job.split(":")[0].strip() for job in jobs] == ["the first values", "lenses.count=3", "depth=room"]


def test_as_json(capsys: pytest.CaptureFixture[str]):
    assert run_command([*DEMO, "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert (said["ok"], said["swept"]) == (True, [])
    (job,) = said["jobs"]
    assert job["what"].startswith("demo, 4 lenses; ")
