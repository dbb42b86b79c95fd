"""From Hydra's words for many values to what an exploration may choose from."""

from argparse import Namespace
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from hydra.core.config_loader import ConfigLoader
from hydra.core.override_parser.types import IntervalSweep, Override, RangeSweep, Sweep

from multilens.app.check import named_values, parsed
from multilens.app.compose import config_loader, open_hydra
from multilens.app.given import CONFIG_DIR, folder_of_presets
from multilens.app.refusal import RefusedError, refused_at
from multilens.app.telling import told_in_one_line
from multilens.app.yaml_limits import refuse_wild_folders
from multilens.sweeps.space import Choice, Space, Span

LOG = "log"
"""The one tag that says something: factors count, not differences."""


@dataclass(frozen=True)
class Asked:
    """The words of an exploration, sorted.

    Args:
        space: what may be chosen.
        written: the same by its keys, as it stands on the command line.
        fixed: keys that have one value.
        lines: key=value of these.
        presets: words that name a folder of presets; mostly none.
    """

    space: Space
    written: Mapping[str, str]
    fixed: tuple[str, ...]
    lines: tuple[str, ...]
    presets: tuple[str, ...]


def read_space(words: Sequence[str]) -> Asked:
    """Sort words into what may be chosen and what is fixed.

    Of an interval both ends are meant, of a range what Python's would give.

    Args:
        words: key=value, group=option, some with several values, and `--config-dir FOLDER`.

    Raises:
        RefusedError: a key is unknown, or its values cannot be explored; one line.
    """
    folder, lines = folder_of_presets(words)
    arguments = Namespace(config_path=None, config_dir=folder, overrides=lines)
    refuse_wild_folders(arguments)
    with open_hydra(arguments), told_in_one_line():
        loader = config_loader()
        overrides = parsed(lines, loader)
        swept = [override for override in overrides if override.is_sweep_override()]
        fixed = [override for override in overrides if not override.is_sweep_override()]
        keys = [override.get_key_element() for override in overrides]
        for key in keys:
            if keys.count(key) > 1:
                raise RefusedError(f"{key} must be given once, got it several times")
        return Asked(
            tuple(_dimension(override, loader) for override in swept),
            {override.get_key_element(): _line(override).partition("=")[2] for override in swept},
            tuple(override.get_key_element() for override in fixed),
            tuple(_line(override) for override in fixed),
            () if folder is None else (f"{CONFIG_DIR}={folder}",),
        )


def _line(override: Override) -> str:
    return override.input_line or override.key_or_group


def _dimension(override: Override, loader: ConfigLoader) -> Span | Choice:
    sweep, key = override.value(), override.get_key_element()
    # A glob of a group's options has none.
    tags = {str(tag) for tag in sweep.tags} if isinstance(sweep, Sweep) else set()
    ordered = isinstance(sweep, IntervalSweep | RangeSweep)
    for tag in sorted(tags - ({LOG} if ordered else set())):
        raise RefusedError(f"{override.input_line}: {LOG} is the one tag, of an interval or a range, got {tag}")
    with refused_at("explore"):
        if isinstance(sweep, IntervalSweep):
            low, high = sweep.start, sweep.end
            assert low is not None
            assert high is not None
            return Span(key, low, high, whole=isinstance(low, int) and isinstance(high, int), log=LOG in tags)
        if isinstance(sweep, RangeSweep):
            return _span(key, sweep, LOG in tags)
        return Choice(key, tuple(named_values(override, loader)))


def _span(key: str, sweep: RangeSweep, log: bool) -> Span:
    """Give the span of a range, whose last number is one of it."""
    numbers = sorted(sweep.range())
    if len(numbers) < 2:
        raise ValueError(f"{key}: must be two or more numbers, got {', '.join(map(str, numbers)) or 'none'}")
    whole = all(isinstance(number, int) for number in numbers)
    return Span(key, numbers[0], numbers[-1], step=abs(sweep.step), whole=whole, log=log)
