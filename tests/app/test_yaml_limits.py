from pathlib import Path
from time import monotonic

import pytest

from multilens.app.refusal import RefusedError
from multilens.app.yaml_limits import refuse_wild_file, refuse_wild_files


def written(folder: Path, text: str) -> Path:
    path = folder / "given.yaml"
    path.write_text(text)
    return path


def test_a_bomb_of_aliases_is_refused_at_once(tmp_path: Path):
    rows = ["a0: &a0 [x,x,x,x,x,x,x,x,x]"]
    rows += [f"a{i}: &a{i} [{','.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 10)]
    began = monotonic()
    with pytest.raises(RefusedError, match="aliases written out"):
        refuse_wild_file(written(tmp_path, "\n".join(rows)))
    assert monotonic() - began < 1


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("x: " + "[" * 40 + "]" * 40, "levels deep"),
        ("x: " + "y" * 300_000, "bytes"),
        ("x: &a [*a]", "alias"),
        ("x: [", "must be YAML"),
        ("hydra: {searchpath: [/tmp]}", "command line only"),
    ],
)
def test_a_wild_file_is_refused(text: str, told: str, tmp_path: Path):
    with pytest.raises(RefusedError, match=told):
        refuse_wild_file(written(tmp_path, text))


def test_an_honest_file_passes(tmp_path: Path):
    refuse_wild_file(written(tmp_path, "shape: &s {kind: disc, radius: 3}\nflash: *s\nlogo: *s\n"))


def test_a_folder_that_is_not_there_is_refused(tmp_path: Path):
    with pytest.raises(RefusedError, match="none there"):
        refuse_wild_files(tmp_path / "nowhere")
