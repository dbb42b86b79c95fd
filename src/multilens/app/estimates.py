"""Which numbers of a configuration no source gives, and what each rests on: a preset marks them, and the output says them."""

from collections.abc import Iterable, Iterator
from typing import Any

from multilens.app.back_file import told_of_file
from multilens.app.keys import is_known
from multilens.app.photometry import PHOTOMETRIC
from multilens.app.refusal import RefusedError, one_line
from multilens.app.schema import BackConfig, Config, LensConfig, LensesConfig
from multilens.storage import ESTIMATES

EACH = "lenses.each."


def estimates(config: Config, given: Iterable[str] = ()) -> dict[str, str]:
    """Give the reason of every number that is an estimate, by its whole key; of sensors only where a photometric cue reads them.

    Args:
        config: what is asked.
        given: keys that the command line sets: whatever stood there before, it is the user's own now.
    """
    own = {key.lstrip("+~") for key in given}
    unused = () if PHOTOMETRIC & set(config.cues.names) else ("sensor",)
    return {
        f"{above}.{key}": one_line(reason)
        for above, part in _parts(config)
        for key, reason in part.estimates.items()
        if not key.startswith(unused)
        and not any(f"{above}.{key}.".startswith(f"{mine}.") for mine in own if mine not in ("back", "lenses"))
    }


def notes(config: Config, given: Iterable[str] = ()) -> str:
    """Say what is worth knowing of where the numbers come from: a drawing, estimates; nothing where there is nothing."""
    return "\n\n".join(filter(None, [told_of_file(config.back.file), told(estimates(config, given))]))


def told(reasons: dict[str, str]) -> str:
    """Say in lines what is estimated, keys of one reason together; nothing where all is known."""
    keys: dict[str, list[str]] = {}
    for key, reason in reasons.items():
        keys.setdefault(reason, []).append(key)
    lines = [f"  {', '.join(_shared(below))}: {reason}" for reason, below in keys.items()]
    return "\n".join([ESTIMATES, *lines]) if lines else ""


def _shared(keys: list[str]) -> list[str]:
    """Give keys that differ in the number of the lens alone as one."""
    lenses: dict[str, list[str]] = {}
    for key in keys:
        number, _, below = key.removeprefix(EACH).partition(".")
        numbers = lenses.setdefault(f"{EACH}@.{below}" if key.startswith(EACH) else key, [])
        numbers.append(number)
    return [key.replace("@", ",".join(numbers), 1) for key, numbers in lenses.items()]


def refuse_stray_estimates(config: Config) -> None:
    """Refuse a mark on a number that does not exist.

    Raises:
        RefusedError: an estimate names an unknown key.
    """
    for above, part in _parts(config):
        for key in part.estimates:
            if not is_known(key.split("."), type(part)):
                raise RefusedError(one_line(f"{above}.estimates.{key} must name a key of {above}, got {key}"))


def _parts(config: Config) -> Iterator[tuple[str, Any]]:
    back: BackConfig = config.back
    lenses: LensesConfig = config.lenses
    yield "back", back
    yield "lenses", lenses
    kinds: list[tuple[str, LensConfig | None]] = [("lenses.lens", lenses.lens)]
    kinds += [(f"lenses.each.{index}", lens) for index, lens in enumerate(lenses.each or [])]
    for key, lens in kinds:
        if lens is not None:
            yield key, lens
