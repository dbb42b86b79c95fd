"""What is seen on the terminal while something takes seconds that cannot be counted."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def busy(what: str, visible: bool = True) -> Iterator[Callable[[str], None]]:
    """Show on stderr what is being waited for and for how long; nothing where stderr is no terminal.

    Args:
        what: is done, as "drawing the pictures".
        visible: whether to show anything at all.

    Yields:
        A function that says something else instead.
    """
    if not (visible and sys.stderr.isatty()):
        yield lambda what: None
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(what, total=None)
        yield lambda what: shown.update(task, description=what)
