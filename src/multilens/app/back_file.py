"""From a configuration to a back that is read from a drawing."""

from pathlib import Path

from multilens.app.refusal import RefusedError, one_line, refused_at
from multilens.app.schema_file import BackFileConfig, sha256_of
from multilens.cad.drawing import BackRead, Wanted
from multilens.cad.read import read_with_notes


def read_back_file(config: BackFileConfig) -> BackRead:
    """Read the back, and tell what is worth knowing of it.

    Raises:
        RefusedError: there is no such file, it cannot be read, it is another than it was, or there is no back in it.
    """
    assert config.path is not None
    path = Path(config.path)
    if not path.is_file():
        raise RefusedError(f"back.file.path must be a file, there is none at {path}")
    found = sha256_of(config.path)
    if found is not None and config.sha256 not in (None, found):
        raise RefusedError(f"back.file.sha256 must be {found}, that of {path} as it is now, got {config.sha256}")
    keep_outs = None if config.keep_outs is None else tuple(config.keep_outs)
    wanted = Wanted(config.outline, keep_outs, config.clearance, config.tolerance)
    try:
        with refused_at("back.file"):
            return read_with_notes(path, config.units, wanted)
    except ModuleNotFoundError as error:
        raise RefusedError(f"back.file: {error}") from None
    except OSError as error:
        raise RefusedError(one_line(f"back.file.path: {error}")) from None


def told_of_file(config: BackFileConfig) -> str:
    """Say in lines what was read; nothing where no file is."""
    if config.path is None:
        return ""
    return "\n".join([f"back from {config.path}:", *(f"  {line}" for line in str(read_back_file(config)).splitlines())])
