"""Words of the command line become a checked configuration, or one line that says why not."""

from pathlib import Path

import pytest

from multilens.app.given import read_given
from multilens.app.refusal import RefusedError


def test_words_are_composed_as_hydra_would():
    given = read_given(["experiment=spider", "lenses.count=3"])
    assert (given.config.name, given.config.lenses.count, given.config.depth.near) == ("spider", 3, 20.0)


def test_the_text_is_the_whole_configuration_and_ours_alone():
    text = read_given(["experiment=spider"]).text
    assert "name: spider\n" in text
    assert "hydra" not in text
    assert "${" not in text


def test_the_keys_are_those_that_the_words_set():
    assert read_given(["depth=portrait", "lenses.count=2"]).keys == ("depth", "lenses.count")


def test_presets_of_ones_own_are_found(tmp_path: Path):
    (tmp_path / "depth").mkdir()
    (tmp_path / "depth" / "desk.yaml").write_text("near: 400\nfar: 900\n", encoding="utf-8")
    assert read_given(["--config-dir", str(tmp_path), "depth=desk"]).config.depth.far == 900


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["lenses.count=1,2"], "one value"),
        (["-m"], "got a flag"),
        (["--config-dir"], "followed by a folder"),
        (["back=tabel"], "back=tabel"),
        (["depth.near=-5"], "depth.near must be > 0 mm"),
        (["lenses.cuont=3"], "did you mean lenses.count?"),
    ],
)
def test_what_cannot_be_composed_is_refused_in_one_line(words: list[str], told: str):
    with pytest.raises(RefusedError, match=r"\A[^\n]*\Z") as refusal:
        read_given(words)
    assert told in str(refusal.value)
