"""The end of a sweep: neighbours' layouts are tried on each of its jobs, told on the terminal where that takes a while."""

from itertools import starmap
from pathlib import Path
from time import monotonic

from rich.console import Console

from multilens.app.ending import tell, told
from multilens.sweeps.compute import Compute

AT_ONCE = 2.0
"""s; what takes no longer needs no telling."""


def let_neighbours_agree(folder: Path, compute: Compute = starmap) -> bool:
    """Let the jobs of a sweep begin from each other's layouts, and say how many became better by it.

    Args:
        folder: of the sweep.
        compute: does the work of many jobs, here or in workers.

    Returns:
        Whether that could be done; if not, one line on stderr has said why, and every job is as its own search left it.
    """
    from multilens.sweeps.agreement import agree_in

    began, status = monotonic(), Console(stderr=True).status("")

    def listen(turn: int, job: int) -> None:
        if monotonic() - began > AT_ONCE:
            status.update(f"jobs begin from their neighbours' layouts: pass {turn}, job {job}")
            status.start()

    try:
        better = agree_in(folder, listen, compute)
    except Exception as error:
        # Whatever it is, the finished jobs have their table.
        tell(f"neighbours cannot agree: {told(error)}")
        return False
    finally:
        status.stop()
    if better:
        print(f"jobs that are better by their neighbours' layouts: {len(better)}")
    return True
