from itertools import pairwise
from math import log

import pytest
from matplotlib.figure import Figure

from multilens.plot.axis import tick_in_plain_numbers


def named_ticks(low, high):
    ax = Figure().add_axes((0.1, 0.1, 0.8, 0.8))
    ax.set(yscale="log", ylim=(low, high))
    tick_in_plain_numbers(ax.yaxis)
    ax.figure.draw_without_rendering()
    return {
        tick.get_loc(): tick.label1.get_text()
        for tick in [*ax.yaxis.get_major_ticks(), *ax.yaxis.get_minor_ticks()]
        if low <= tick.get_loc() <= high and tick.label1.get_text()
    }


@pytest.mark.parametrize(("low", "high"), [(1.2, 1.4), (0.3, 2.9), (0.02, 1.7), (0.001, 5.0), (3e3, 8e5)])
def test_a_logarithmic_axis_names_some_ticks_as_plain_numbers(low, high):
    named = named_ticks(low, high)
    assert len(named) >= 2
    assert all(float(words) == pytest.approx(value) for value, words in named.items())


@pytest.mark.parametrize(("low", "high"), [(0.85, 1.39), (0.35, 1.39), (1.01, 1.04), (7.5, 14.0)])
def test_no_half_of_a_short_axis_is_without_a_tick(low, high):
    places = [low, *sorted(named_ticks(low, high)), high]
    assert max(log(after / before) for before, after in pairwise(places)) < log(high / low) / 2
