"""The presets that there are."""

from pathlib import Path

from multilens.app.presets import config_folder, preset_groups


def test_groups_are_folders_and_options_files(tmp_path: Path):
    for path in ("config.yaml", "b/two.yaml", "b/one.yaml", "a/deep/three.yaml", "a/notes.txt"):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).touch()
    assert preset_groups([tmp_path, tmp_path]) == {"a/deep": ["three"], "b": ["one", "two"]}


def test_the_presets_lie_where_the_configuration_does():
    assert (config_folder() / "config.yaml").is_file()
    assert "devices" not in preset_groups([config_folder()])["experiment"]
