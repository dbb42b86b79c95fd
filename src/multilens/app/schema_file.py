"""What a configuration may hold of a drawing that the back is read from."""

from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from omegaconf import OmegaConf


@dataclass
class BackFileConfig:
    """A drawing; what each field means is told by `multilens.cad.read.read_back`.

    Args:
        path: of the DXF, SVG, GeoJSON or WKT file, from where the command runs; null for a back that is written out.
        units: of its numbers; null for those that the file says.
        outline: layer of the outline.
        keep_outs: layers of the keep-outs, [] for none; null takes "keep-outs" where there is one.
        clearance: that bodies keep from a keep-out of which the file says none, mm.
        tolerance: by which a rim that cannot be exact may move to the safe side, mm.
        sha256: that the file must have; null for any.
    """

    path: str | None = None
    units: str | None = None
    outline: str = "outline"
    keep_outs: list[str] | None = None
    clearance: float = 0.0
    tolerance: float = 0.01
    sha256: str | None = None


def sha256_of(path: str | None) -> str | None:
    """Give the checksum of a file, and None for one that cannot be read or is too large, of which whoever reads it tells more."""
    # A device may have no end.
    if path is None or not Path(path).is_file():
        return None
    from multilens.cad.read import LARGEST_FILE

    try:
        with Path(path).open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
    except OSError:
        return None
    return sha256(content).hexdigest() if len(content) <= LARGEST_FILE else None


# Wherever a configuration is resolved, in a worker too, the schema is loaded: `conf/back/file.yaml` has the checksum from here.
OmegaConf.register_new_resolver("sha256_of", sha256_of, replace=True)
