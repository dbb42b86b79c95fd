import pytest
from omegaconf import OmegaConf

from multilens.app.plain import plain, yaml_text


@pytest.mark.parametrize("text", ["1e3", "12", "0x1F", "true", "null", "plain", "a: b", "Ümlaut", "", "1_000", "nan"])
def test_a_text_is_read_back_as_it_was(text: str) -> None:
    assert OmegaConf.to_container(OmegaConf.create(yaml_text({"key": text}))) == {"key": text}


def test_the_text_is_omegaconfs() -> None:
    data = {"name": "demo", "depth": {"near": 200.0, "edges": []}, "each": None, "lists": [[1, 2.5], ["1e3"]]}
    assert yaml_text(data) == OmegaConf.to_yaml(OmegaConf.create(data))


def test_hydras_part_is_left_out_and_what_refers_to_other_keys_is_resolved() -> None:
    config = OmegaConf.create({"hydra": {"run": 1}, "near": 2.0, "far": "${near}"})
    assert plain(config) == {"near": 2.0, "far": 2.0}
