"""The end of a sweep: what is still missing, agreement, a table of all its jobs, and their pictures."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hydra.core.global_hydra import GlobalHydra
from hydra.core.utils import JobReturn
from hydra.experimental.callback import Callback
from omegaconf import DictConfig

from multilens.app.agreeing import let_neighbours_agree
from multilens.app.compose import quicken
from multilens.app.ending import BAD_INPUT, BROKEN_PIPE, DONE, NOTHING_FOUND, SYSTEM_FAILED, tell, told
from multilens.app.pictures import pictures_drawn
from multilens.app.refusal import RefusedError
from multilens.app.workers import computing_as, end_workers, prepare_workers
from multilens.sweep_row import Cell


class SweepTable(Callback):
    """Writes and prints the table of a sweep when its last job has ended; Hydra calls it once, where the sweep was started."""

    def on_multirun_start(self, config: DictConfig, **kwargs: Any) -> None:
        """Have workers be new, with one thread each, and configurations composed quickly."""
        prepare_workers()
        hydra = GlobalHydra.instance().hydra
        assert hydra is not None
        quicken(hydra)

    def on_job_end(self, config: DictConfig, job_return: JobReturn, **kwargs: Any) -> None:
        """Let go of the two copies of a job's configuration, of which Hydra would keep every job's to the end of the sweep."""
        job_return.cfg = job_return.hydra_cfg = None

    def on_multirun_end(self, config: DictConfig, **kwargs: Any) -> None:
        """Wait for what others compute, let neighbours agree, write the table of the jobs' folders, draw its pictures, print it.

        Raises:
            SystemExit: a job found nothing, code 3; the folder holds another sweep's job, code 2; something could not be read
                or written, or is a fault of ours, code 1.
        """
        # Hydra would make a warning of any other exception, and go on.
        try:
            code = _end(config)
        except BrokenPipeError:
            code = BROKEN_PIPE
        except Exception as error:
            tell(told(error))
            code = BAD_INPUT if isinstance(error, RefusedError) else SYSTEM_FAILED
        finally:
            end_workers()
        if code != DONE:
            raise SystemExit(code)


def _end(config: DictConfig) -> int:
    """Do what is to be done once the last job has ended, and give the exit code."""
    from multilens.app.sweep_job import compute_if_missing
    from multilens.app.waiting import finish_waiting
    from multilens.sweep_row import cells
    from multilens.sweeps.table import CSV, without_empty_columns, write_tables

    folder = Path(config.hydra.sweep.dir)
    finish_waiting(folder, compute_if_missing)
    compute = computing_as(config.hydra.launcher)
    agreed = not config.sweep.agree or let_neighbours_agree(folder, compute)
    rows = write_tables(folder)
    print(aligned(without_empty_columns(cells(rows))))
    print(folder / CSV)
    drawn = pictures_drawn(folder, compute)
    if not (agreed and drawn):
        return SYSTEM_FAILED
    return NOTHING_FOUND if any(row.score is None for row in rows) else DONE


def aligned(rows: Sequence[Sequence[Cell]]) -> str:
    """Give rows as lines of text whose columns stand below each other, long numbers shortened to 6 digits."""
    short = [[_shortened(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*short, strict=True)]
    return "\n".join("  ".join(map(str.ljust, row, widths)).rstrip() for row in short)


def _shortened(cell: Cell) -> str:
    if cell is None:
        return ""
    try:
        return f"{float(cell):.6g}"
    except ValueError:
        return str(cell)
