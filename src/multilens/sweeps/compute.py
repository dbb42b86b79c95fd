"""Many tasks of a sweep, computed here or in its workers, whoever calls says where."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

Compute = Callable[[Callable[..., Any], Sequence[tuple[Any, ...]]], Iterable[Any]]
"""What calls a function with the arguments of each task and gives what comes out in their order, such as `itertools.starmap`."""
