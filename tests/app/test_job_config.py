"""What Hydra copies of a job's configuration stays what OmegaConf's own copies of it are."""

from argparse import Namespace
from copy import deepcopy

import pytest
from hydra.core.hydra_config import HydraConfig
from hydra.core.singleton import Singleton
from hydra.types import RunMode
from omegaconf import DictConfig, OmegaConf, open_dict, read_write

from multilens.app.compose import CONFIG_NAME, IS_1_3, config_loader, open_hydra
from multilens.app.job_config import with_common_parts

pytestmark = pytest.mark.skipif(not IS_1_3, reason="from Hydra 1.4 on every copy is OmegaConf's own")


@pytest.fixture
def plain() -> DictConfig:
    with open_hydra(Namespace(config_path=None, config_dir=None)):
        return config_loader().load_configuration(CONFIG_NAME, ["lenses.count=3"], RunMode.RUN)


@pytest.fixture
def config(plain: DictConfig) -> DictConfig:
    return with_common_parts(deepcopy(plain))


def test_it_is_the_same_configuration(config: DictConfig, plain: DictConfig) -> None:
    assert (config, OmegaConf.get_type(config)) == (plain, OmegaConf.get_type(plain))
    assert OmegaConf.to_container(deepcopy(config)) == OmegaConf.to_container(plain)


def test_what_is_taken_out_of_a_copy_stays_in_the_configuration(config: DictConfig, plain: DictConfig) -> None:
    twin = deepcopy(config)
    with read_write(twin), open_dict(twin):
        del twin["hydra"]
    assert "hydra" not in twin
    assert config == plain
    assert OmegaConf.is_struct(twin)


def test_a_copy_that_is_made_read_only_leaves_the_configuration_as_it_is(config: DictConfig) -> None:
    OmegaConf.set_readonly(deepcopy(config), True)
    assert not OmegaConf.is_readonly(config)


def test_its_parts_are_there_once(config: DictConfig) -> None:
    assert deepcopy(config).lenses is config.lenses
    assert deepcopy(config.hydra).runtime is config.hydra.runtime


def test_a_job_finds_in_hydras_part_what_was_set_last(config: DictConfig) -> None:
    # As Hydra does it: the folder is known only once the configuration can be asked for it.
    state = Singleton.get_state()
    try:
        HydraConfig.instance().set_config(config)
        with read_write(config.hydra.runtime):
            config.hydra.runtime.output_dir = "sweeps/0"
        HydraConfig.instance().set_config(config)
        assert HydraConfig.get().runtime.output_dir == "sweeps/0"
        assert HydraConfig.get().run.dir.startswith(f"runs/{config.name}/")
    finally:
        Singleton.set_state(state)
