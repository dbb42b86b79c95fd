"""What the axes of several pictures have alike: a faint grid, and numbers along them that are read at a glance."""

from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, MaxNLocator, NullLocator

SHORT = 4.0
"""A logarithmic axis whose ends differ by less has round numbers as a linear one: those of one digit may be few and at one end."""


def draw_grid(ax: Axes) -> None:
    """Draw a faint grid behind everything else."""
    ax.grid(True, which="major", color="#ececec", linewidth=0.8)
    ax.set_axisbelow(True)


def tick_in_plain_numbers(axis: Axis) -> None:
    """Name ticks of a logarithmic axis as plain numbers, no more of them than have room; its limits must be final."""
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    low, high = sorted(axis.get_view_interval())
    if high / low < SHORT:
        axis.set_major_locator(MaxNLocator(nbins=6, steps=[1, 2, 2.5, 5, 10]))
        axis.set_minor_locator(NullLocator())
        return
    # Of a short range every digit is named, of a longer one three, and of a long one the powers of ten alone.
    named = "123456789" if high / low < 8 else "125" if high / low < 100 else ""
    axis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}" if f"{value:.0e}"[0] in named else ""))
