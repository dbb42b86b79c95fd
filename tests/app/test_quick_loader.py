"""Configurations that are composed quickly are those that Hydra composes."""

from argparse import Namespace

import pytest
from hydra._internal.config_loader_impl import ConfigLoaderImpl
from hydra.errors import ConfigCompositionException
from hydra.types import RunMode
from omegaconf import OmegaConf

from multilens.app.compose import CONFIG_NAME, IS_1_3, config_loader, open_hydra
from multilens.app.quick_loader import QuickLoader

pytestmark = pytest.mark.skipif(not IS_1_3, reason="from Hydra 1.4 on every job is composed from its files")


def both(lines: list[str]) -> tuple[object, object]:
    """Give what the quick loader composes, after it has composed something like it, and what Hydra's own does."""
    with open_hydra(Namespace(config_path=None, config_dir=None)):
        quick = config_loader()
        assert isinstance(quick, QuickLoader)
        quick.load_configuration(CONFIG_NAME, ["lenses.count=7", *lines], RunMode.RUN)
        return tuple(
            OmegaConf.to_container(kind.load_configuration(quick, CONFIG_NAME, lines, RunMode.RUN), enum_to_str=True)
            for kind in (QuickLoader, ConfigLoaderImpl)
        )


@pytest.mark.parametrize(
    "lines",
    [
        [],
        ["lenses.count=3", "search.seed=4"],
        ["experiment=spider", "depth=portrait", "depth.near=250"],
        ["depth.near=250", "depth=portrait", "experiment=phone_back"],
        ["back=rectangle", "back.outline={kind: disc, radius: 30, width: null, height: null}"],
        [
            "experiment=demo",
            "+back.keep_outs={button:{shape:{kind:disc,centre:[10,60],radius:3}}}",
            "~back.keep_outs.logo",
        ],
        ["hydra/launcher=joblib", "hydra.launcher.n_jobs=2", "name=mine", "hydra.sweep.dir=sweeps/${name}"],
    ],
)
def test_the_same_words_give_the_same_configuration(lines: list[str]) -> None:
    quick, slow = both(lines)
    assert quick == slow


def test_a_copy_that_is_changed_leaves_the_others_as_they_are() -> None:
    with open_hydra(Namespace(config_path=None, config_dir=None)):
        first, second = (config_loader().load_configuration(CONFIG_NAME, [], RunMode.RUN) for _ in range(2))
        first.lenses.count = 9
        assert second.lenses.count == 4


@pytest.mark.parametrize("line", ["lenses.count=many", "lenses.cuont=3", "search=quik"])
def test_what_hydra_refuses_is_refused(line: str) -> None:
    with open_hydra(Namespace(config_path=None, config_dir=None)), pytest.raises(ConfigCompositionException):
        config_loader().load_configuration(CONFIG_NAME, [line], RunMode.RUN)
