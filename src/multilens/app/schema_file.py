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
        keep_outs: layers of the keep-outs; null takes "keep-outs" where there is one.
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
    """Give the checksum of a file, and None for one that cannot be read, of which whoever reads it tells more."""
    try:
        return None if path is None else sha256(Path(path).read_bytes()).hexdigest()
    except OSError:
        return None


# Wherever a configuration is resolved, in a worker too, the schema is loaded: `conf/back/file.yaml` has the checksum from here.
OmegaConf.register_new_resolver("sha256_of", sha256_of, replace=True)
