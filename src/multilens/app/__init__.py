"""The command line: `multilens experiment=NAME key=value ...`, with `-m` for sweeps, and `multilens plot RUN_FOLDER`."""

import sys


def main() -> None:
    """Run the command in `sys.argv` and leave with its exit code.

    0 done, 1 the system failed (a full disk), 2 bad input, 3 nothing feasible or no healthy start, 130 interrupted,
    143 terminated.
    """
    from multilens.app.command import run_command

    sys.exit(run_command(sys.argv[1:]))
