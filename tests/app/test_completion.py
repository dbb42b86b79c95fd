"""What the Tab key offers; the shell keeps what begins with the word, so offers that do not are left out here already."""

from pathlib import Path

import pytest

from multilens.app.command import COMMANDS, run_command


@pytest.fixture
def offered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.chdir(tmp_path)

    def offer(line: str) -> set[str]:
        monkeypatch.setenv("COMP_LINE", line)
        assert run_command(["-sc", "query=bash"]) == 0
        return set(capsys.readouterr().out.split())

    return offer


def test_the_first_word_is_a_command_or_a_key(offered):
    assert offered("multilens ") > {*COMMANDS, "experiment=", "depth=", "depth.", "name="}
    assert offered("multilens ev") == {"evaluate"}
    assert offered("/usr/bin/multilens val") == {"validate-config"}


@pytest.mark.parametrize(
    "before", ["", "design ", "evaluate ", "validate-config ", "-m experiment=demo ", "least lenses "]
)
def test_keys_and_presets_are_offered_behind_a_command(before: str, offered):
    assert offered(f"multilens {before}search=") == {"search=default", "search=quick", "search=thorough"}
    assert offered(f"multilens {before}lenses.c") == {"lenses.count="}


def test_presets_in_folders_are_offered(offered):
    assert offered("multilens experiment=devices/wo") == {"experiment=devices/wolf_spider"}


def test_least_must_be_told_of_what(offered):
    assert offered("multilens least ") == {"lenses", "size", "aperture"}


def test_run_folders_are_offered_where_they_are_meant(tmp_path: Path, offered):
    (tmp_path / "runs" / "a").mkdir(parents=True)
    (tmp_path / "runs" / "a" / "design.json").touch()
    assert offered("multilens plot ") == {"runs/"}
    assert offered("multilens plot runs/a") == {"runs/a/"}
    assert offered("multilens evaluate runs/a/") == {"runs/a/design.json"}


def test_flags_are_offered_behind_a_dash(offered):
    assert offered("multilens design --j") == {"--json"}


def test_a_word_that_is_wrong_says_nothing(offered, capsys: pytest.CaptureFixture[str]):
    assert offered("multilens experiment=dmeo lenses.c") == set()
    assert capsys.readouterr().err == ""
