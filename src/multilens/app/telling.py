"""What Hydra and OmegaConf raise, told in one line."""

from collections.abc import Iterator
from contextlib import contextmanager

from hydra.errors import HydraException, MissingConfigException, OverrideParseException
from omegaconf.errors import ConfigAttributeError, ConfigKeyError, OmegaConfBaseException

from multilens.app.keys import is_known, no_such_option, unknown_key
from multilens.app.refusal import RefusedError, one_line


@contextmanager
def told_in_one_line() -> Iterator[None]:
    """Turn whatever Hydra and OmegaConf raise inside into a refusal."""
    try:
        yield
    except (HydraException, OmegaConfBaseException) as error:
        raise RefusedError(_line_of(error)) from None
    except RecursionError:
        raise RefusedError("the configuration must not be nested without end, got one that is") from None


def _line_of(error: Exception) -> str:
    cause: BaseException | None = error
    while cause is not None and not isinstance(cause, OmegaConfBaseException):
        cause = cause.__cause__ or cause.__context__
    if isinstance(error, OverrideParseException):
        return one_line(f"{error.override}: must be written key=value, got {error.message.splitlines()[0]}")
    if isinstance(error, MissingConfigException) and error.missing_cfg_file is not None and error.options:
        group, _, name = error.missing_cfg_file.rpartition("/")
        return no_such_option(group or "configuration", name, error.options)
    if isinstance(cause, ConfigKeyError | ConfigAttributeError) and cause.full_key:
        key = str(cause.full_key)
        if is_known(key.split(".")):
            return one_line(f"{key} is not there yet: a + before the key adds it")
        return unknown_key(key, key)
    if isinstance(cause, OmegaConfBaseException) and "does not support deletion" in str(cause):
        given = str(error).removeprefix("Error merging override ").splitlines()[0].partition(":")[0]
        return one_line(f"{given}: ~ must name one of a list, as a keep-out; set {given.lstrip('~')}=null instead")
    if isinstance(cause, OmegaConfBaseException) and cause.full_key:
        at = (
            str(error).removeprefix("Error merging override ").splitlines()[0] if cause is not error else cause.full_key
        )
        return one_line(f"{at}: {(cause.msg or str(cause)).splitlines()[0]}")
    return one_line(str(error).splitlines()[0] if str(error) else type(error).__name__)
