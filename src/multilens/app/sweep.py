"""The end of a sweep: a table of all its jobs."""

import csv
from pathlib import Path
from typing import Any

from hydra.experimental.callback import Callback
from omegaconf import DictConfig

from multilens.app.ending import NOTHING_FOUND


class SweepTable(Callback):
    """Writes and prints the table of a sweep when its last job has ended; Hydra calls it once, where the sweep was started."""

    def on_multirun_end(self, config: DictConfig, **kwargs: Any) -> None:
        """Write the table of the jobs' folders and print it.

        Raises:
            SystemExit: a job found nothing, code 3.
        """
        from multilens.runs import write_sweep_table

        folder = Path(config.hydra.sweep.dir)
        rows = write_sweep_table(folder)
        with (folder / "table.csv").open(newline="", encoding="utf-8") as file:
            cells = list(csv.reader(file))
        # What all jobs share is in the file; on the terminal it would only take room.
        shared = set.intersection(*(set(row.overrides) for row in rows)) if len(rows) > 1 else set()
        keys = {override.partition("=")[0] for override in shared}
        shown = [index for index, head in enumerate(cells[0]) if head not in keys]
        print(aligned([[row[index] for index in shown] for row in cells]))
        print(folder / "table.csv")
        if any(row.score is None for row in rows):
            raise SystemExit(NOTHING_FOUND)


def aligned(rows: list[list[str]]) -> str:
    """Give rows as lines of text whose columns stand below each other, long numbers shortened to 6 digits."""
    short = [[_shortened(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*short, strict=True)]
    return "\n".join("  ".join(map(str.ljust, row, widths)).rstrip() for row in short)


def _shortened(cell: str) -> str:
    try:
        return f"{float(cell):.6g}"
    except ValueError:
        return cell
