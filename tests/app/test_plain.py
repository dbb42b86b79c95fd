from argparse import Namespace

import pytest
from hydra import compose
from omegaconf import OmegaConf

from multilens.app import build
from multilens.app.compose import CONFIG_NAME, open_hydra
from multilens.app.plain import plain, yaml_text


@pytest.mark.parametrize("text", ["1e3", "12", "0x1F", "true", "null", "plain", "a: b", "Ümlaut", "", "1_000", "nan"])
def test_a_text_is_read_back_as_it_was(text: str) -> None:
    assert OmegaConf.to_container(OmegaConf.create(yaml_text({"key": text}))) == {"key": text}


def test_the_text_is_omegaconfs() -> None:
    data = {"name": "demo", "depth": {"near": 200.0, "edges": []}, "each": None, "lists": [[1, 2.5], ["1e3"]]}
    assert yaml_text(data) == OmegaConf.to_yaml(OmegaConf.create(data))


@pytest.mark.parametrize(
    "words", [["experiment=demo"], ["experiment=wide_ultrawide_tele", "name=1e3"], ["back=d3s", "metric=worst_case"]]
)
def test_plain_data_are_omegaconfs(words: list[str]) -> None:
    with open_hydra(Namespace(config_path=None, config_dir=None)):
        config = compose(CONFIG_NAME, words)
    expected = OmegaConf.to_container(config, resolve=True, enum_to_str=True)
    assert plain(build.typed(config)) == expected
    # Keys in their order: that is how the file is written.
    assert yaml_text(plain(build.typed(config))) == OmegaConf.to_yaml(config, resolve=True)
