"""The command line: `multilens COMMAND ...`, where no command means `design`."""

import sys


def main() -> None:
    """Run the command in `sys.argv` and leave with its exit code.

    0 done, 1 the system failed (a full disk), 2 bad input, 3 nothing feasible or no healthy start, 130 interrupted,
    141 nobody reads the output any more, 143 terminated.
    """
    from multilens.app.ending import INTERRUPTED, tell

    try:
        from multilens.app.command import run_command
    except KeyboardInterrupt:
        tell("interrupted before it began")
        sys.exit(INTERRUPTED)
    sys.exit(run_command(sys.argv[1:]))
