"""The help on everything."""

from pathlib import Path

import yaml

from multilens.app.help import help_text
from multilens.app.presets import config_folder


def test_nothing_is_left_to_fill_in():
    assert "${" not in help_text()
    assert 'eval "$(multilens -sc install=bash)"' in help_text()


def test_the_text_is_that_of_the_configuration():
    told = yaml.safe_load((config_folder() / "config.yaml").read_text())["hydra"]["help"]
    assert help_text().startswith(told["header"].strip())
    assert "\nfield_of_view: main_camera, straight_ahead, ultra_wide\n" in help_text()


def test_presets_of_ones_own_are_told_too(tmp_path: Path):
    (tmp_path / "depth").mkdir()
    (tmp_path / "depth" / "desk.yaml").write_text("far: 900\n")
    for words in (["--config-dir", str(tmp_path)], [f"--config-dir={tmp_path}"], ["-cd", str(tmp_path)]):
        assert "\ndepth: ar_weighted, desk, " in help_text(words)
    assert "desk" not in help_text()
