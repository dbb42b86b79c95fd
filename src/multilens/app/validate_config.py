"""`multilens validate-config`: everything about a design or a sweep that can be known without a search."""

import json
from argparse import Namespace
from collections.abc import Sequence

from multilens.app import build
from multilens.app.answer import without_flag
from multilens.app.check import check_command_line
from multilens.app.design import read_arguments
from multilens.app.ending import DONE, NOTHING_FOUND, tell
from multilens.app.loading import load_torch
from multilens.app.refusal import RefusedError
from multilens.app.schema import Config

USAGE = """\
multilens validate-config key=value ...    tell without a search whether a design can be made

Takes the words of `multilens design`. Everything is composed and built: keys, presets and ranges, what goes together, whether
every lens has what its cues need, whether the run folder is free, and whether the lenses can fit on the back at all. With -m every
value of every swept key is looked at, each with the first values of the others.

Options
  -m, --multirun           several values of a key, as in lenses.count=2,3,4
  --json                   print what would be run as JSON, and nothing else
  --config-dir FOLDER      take presets of your own as well

Examples
  multilens validate-config experiment=demo
  multilens validate-config -m experiment=phone_back lenses.count=2,3,4,5

Exit codes: 0 it can be run, 2 it cannot be, 3 nothing can fit; one line on stderr says why. That lenses fit by what is looked at
here does not prove that a layout exists."""


def validate_config_command(words: Sequence[str]) -> int:
    """Check what the words ask for, and say what would be run.

    Args:
        words: as of `multilens design`.

    Returns:
        The exit code.

    Raises:
        RefusedError: it cannot be run; one line.
    """
    as_json, words = without_flag(words)
    arguments = read_arguments(words)
    _refuse_other_flags(arguments)
    checked = check_command_line(arguments)
    load_torch()
    for changed, config in checked.configs.items():
        reason = _why_nothing_fits(changed, config)
        if reason is not None:
            tell(reason)
            return NOTHING_FOUND
    jobs = {changed: _in_words(config) for changed, config in checked.configs.items()}
    if as_json:
        records = [{"changed": changed, "what": what} for changed, what in jobs.items()]
        print(json.dumps({"ok": True, "swept": list(checked.swept), "jobs": records}, indent=2))
    else:
        print(_said(jobs, checked.swept))
    return DONE


def _refuse_other_flags(arguments: Namespace) -> None:
    for name in ("cfg", "info", "hydra_help", "shell_completion"):
        if getattr(arguments, name):
            raise RefusedError(
                f"--{name.replace('_', '-')} is no flag of validate-config; multilens validate-config --help shows which are"
            )


def _why_nothing_fits(changed: str, config: Config) -> str | None:
    from multilens.search.fit import why_nothing_fits

    where = f"{changed}: " if changed else ""
    try:
        reason = why_nothing_fits(build.build_question(config))
    except RefusedError as refusal:
        raise RefusedError(f"{where}{refusal}") from None
    return None if reason is None else where + reason


def _said(jobs: dict[str, str], swept: Sequence[str]) -> str:
    if not swept:
        return f"OK: {jobs['']}"
    lines = [f"  {changed or 'the first values'}: {what}" for changed, what in jobs.items()]
    return "\n".join([f"OK: a sweep of {', '.join(swept)}; looked at were", *lines])


def _in_words(config: Config) -> str:
    """Say what would be run: the lenses, the depths, the cues, what is scored and how it is searched for."""
    count = len(config.lenses.each) if config.lenses.each is not None else config.lenses.count
    depth, search = config.depth, config.search
    parts = [
        f"{config.name}, {count} {'lens' if count == 1 else 'lenses'}",
        f"{depth.count} depths from {depth.near:g} to {depth.far:g} mm",
        f"cues {', '.join(cue.name for cue in config.cues.names)}",
        f"metric {config.metric.name.name}",
        f"{search.starts} starts, patience {search.patience}, seed {search.seed}",
    ]
    return "; ".join(parts)
