"""The agreement of jobs in the folder of a sweep."""

import os
import shutil
from dataclasses import replace
from pathlib import Path

import jaxtyping
import pytest
import torch

import multilens as ml
from multilens.certificate import certify
from multilens.runs import write_design, write_words
from multilens.sweeps import agreement
from multilens.sweeps.agreement import agree_in, end_moving, end_moving_of
from multilens.sweeps.job import read_job, refuse_damaged, row_of, write_job
from multilens.sweeps.table import read_rows

LENS = ml.Lens(5.0, (0.5, 2.0), clearance=1.5, disparity_noise=1e-3, blur_noise=1e-3)


@pytest.fixture(autouse=True)
def _shapes_are_checked_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)


@pytest.fixture(scope="module")
def own() -> dict[int, ml.Design]:
    """Of two, three and four lenses, the three found badly: all focused on the nearest depth."""
    problems = [
        ml.Problem(ml.Back.rectangle(40, 30), [LENS] * count, ml.log_depths(300, 2000, 32)) for count in (2, 3, 4)
    ]
    found = {job: ml.solve(problem, starts=1, patience=0, proof=0, seed=3) for job, problem in enumerate(problems)}
    three = found[1].layout
    near = ml.Layout(three.position, three.aperture_radius, torch.full_like(three.focus, 300))
    problem = problems[1]
    proof = certify(problem.back, problem.lenses, problem.focus_range, near, problem.gap)
    return found | {1: replace(found[1], layout=near, certificate=proof)}


def write(folder: Path, job: int, design: ml.Design) -> None:
    def write_files(inside: Path) -> None:
        write_design(inside, design)
        write_words(inside, f"lenses: {design.layout.count}\n", "found\n")

    row = row_of(design, job, (("lenses.count", str(design.layout.count)),), 1.5)
    write_job(folder / str(job), f"print {job}", row, write_files)


@pytest.fixture
def sweep(tmp_path: Path, own: dict[int, ml.Design]) -> Path:
    folder = tmp_path / "sweep"
    folder.mkdir()
    for job, design in own.items():
        write(folder, job, design)
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    """Give every file but the locks, which are empty."""
    files = (path for path in sorted(folder.rglob("*")) if path.is_file() and path.suffix != ".lock")
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


def better(folder: Path) -> list[int]:
    return [int(path.parent.name) for path in folder.glob("*/alone.json")]


def test_a_better_design_takes_the_place_and_the_jobs_own_stays_beside_it(
    sweep: Path, own: dict[int, ml.Design]
) -> None:
    agree_in(sweep)
    assert better(sweep)
    for job in better(sweep):
        assert ml.Design.load(sweep / str(job) / "alone.json").to_json() == own[job].to_json()
        assert ml.Design.load(sweep / str(job) / "design.json").score < own[job].score


def test_rows_are_those_of_the_designs(sweep: Path) -> None:
    before = read_rows(sweep)
    agree_in(sweep)
    for row, old in zip(read_rows(sweep), before, strict=True):
        assert row.score == ml.Design.load(sweep / str(row.job) / "design.json").score
        assert (row.time, row.settings) == (old.time, old.settings)


def test_every_folder_is_sealed_anew(sweep: Path) -> None:
    prints = [read_job(sweep / str(job)).fingerprint for job in range(3)]
    agree_in(sweep)
    for job in range(3):
        refuse_damaged(sweep / str(job), read_job(sweep / str(job)))
    assert [read_job(sweep / str(job)).fingerprint for job in range(3)] == prints


def test_what_has_agreed_is_not_computed_again(sweep: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    agree_in(sweep)
    before = contents(sweep)
    monkeypatch.setattr(agreement, "agree", lambda *others: pytest.fail("computed again"))
    agree_in(sweep)
    assert contents(sweep) == before


def test_a_job_that_is_computed_again_gives_the_same_bytes(sweep: Path, own: dict[int, ml.Design]) -> None:
    agree_in(sweep)
    before, job = contents(sweep), better(sweep)[0]
    shutil.rmtree(sweep / str(job))
    write(sweep, job, own[job])
    agree_in(sweep)
    assert contents(sweep) == before


def test_a_job_that_is_not_better_any_more_has_its_own_design_again(sweep: Path) -> None:
    alone = contents(sweep)
    agree_in(sweep)
    kept = better(sweep)[0]
    for other in {0, 1, 2} - {kept}:
        shutil.rmtree(sweep / str(other))
    agree_in(sweep)
    (sweep / "agreement.json").unlink()
    assert contents(sweep) == {name: text for name, text in alone.items() if name.startswith(f"{kept}/")}


class KilledError(BaseException):
    """Stands for a kill: nobody catches it."""


@pytest.mark.parametrize("steps", range(16))
def test_killed_while_files_move_it_ends_the_same(
    sweep: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, steps: int
) -> None:
    undisturbed = tmp_path / "undisturbed"
    shutil.copytree(sweep, undisturbed)
    agree_in(undisturbed)
    replaced, taken = os.replace, []

    def killed_after_some(source: Path, target: Path) -> None:
        if len(taken) == steps:
            raise KilledError
        taken.append(source)
        replaced(source, target)

    monkeypatch.setattr(os, "replace", killed_after_some)
    try:
        agree_in(sweep)
    except KilledError:
        monkeypatch.setattr(os, "replace", replaced)
        end_moving(sweep)
        agree_in(sweep)
    assert contents(sweep) == contents(undisturbed)


def kill_while_moving(sweep: Path) -> Path:
    """Have an agreement end as by a kill, once it has moved the first design, and give that job's folder."""
    replaced, taken = os.replace, []

    def killed_after_one(source: Path, target: Path) -> None:
        if taken:
            raise KilledError
        replaced(source, target)
        if target.name == "design.json" and target.parent.parent == sweep:
            taken.append(target)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "replace", killed_after_one)
        with pytest.raises(KilledError):
            agree_in(sweep)
    return taken[0].parent


def test_a_job_that_was_removed_after_a_kill_is_computed_again(
    sweep: Path, own: dict[int, ml.Design], tmp_path
) -> None:
    undisturbed = tmp_path / "undisturbed"
    shutil.copytree(sweep, undisturbed)
    agree_in(undisturbed)
    half = kill_while_moving(sweep)
    shutil.rmtree(half)
    end_moving(sweep)
    assert not half.exists()
    write(sweep, int(half.name), own[int(half.name)])
    agree_in(sweep)
    assert contents(sweep) == contents(undisturbed)


def test_whoever_comes_to_a_job_after_a_kill_finds_it_whole(sweep: Path, tmp_path: Path) -> None:
    undisturbed = tmp_path / "undisturbed"
    shutil.copytree(sweep, undisturbed)
    agree_in(undisturbed)
    half = kill_while_moving(sweep)
    with pytest.raises(ValueError, match=r"design\.json was altered"):
        refuse_damaged(half, read_job(half))
    end_moving_of(half)
    refuse_damaged(half, read_job(half))
    end_moving(sweep)
    assert contents(sweep) == contents(undisturbed)


def test_a_marker_that_is_damaged_is_made_again(sweep: Path) -> None:
    agree_in(sweep)
    before = contents(sweep)
    (sweep / "agreement.json").write_text("{}")
    agree_in(sweep)
    assert contents(sweep) == before


def test_a_damaged_job_is_named_and_nothing_is_changed(sweep: Path) -> None:
    (sweep / "1" / "design.json").write_text("{}")
    before = contents(sweep)
    with pytest.raises(ValueError, match="schema"):
        agree_in(sweep)
    assert contents(sweep) == before
