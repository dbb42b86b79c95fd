"""The end of a sweep: its pictures are drawn, and their paths printed."""

from itertools import starmap
from pathlib import Path

from multilens.app.ending import tell, told
from multilens.sweeps.compute import Compute


def pictures_drawn(folder: Path, compute: Compute = starmap) -> bool:
    """Draw the pictures of a sweep and print their paths.

    Args:
        folder: of the sweep.
        compute: draws them, here or in workers.

    Returns:
        Whether that could be done; if not, one line on stderr has said why, and the tables are there without them.
    """
    from multilens.sweeps.pictures import draw_pictures

    try:
        pictures = draw_pictures(folder, compute)
    except Exception as error:
        # Whatever it is, the tables are printed already.
        tell(f"the pictures cannot be drawn: {told(error)}")
        return False
    for picture in pictures:
        print(folder / picture.name)
    return True
