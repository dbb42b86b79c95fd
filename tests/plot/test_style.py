from itertools import combinations

import matplotlib
import pytest

from multilens.cues import LensDefocus, PairStereo
from multilens.lens import Lens
from multilens.plot.style import ink_on, lens_colour, measurement_colour, measurement_dashes, style, tint

LENS = Lens(6.0, (0.5, 2.0))


def test_a_colour_does_not_depend_on_how_many_lenses_there_are():
    few = {
        m.label: measurement_colour(m) for cue in (PairStereo(), LensDefocus()) for m in cue.measurements([LENS] * 3)
    }
    many = {
        m.label: measurement_colour(m) for cue in (PairStereo(), LensDefocus()) for m in cue.measurements([LENS] * 9)
    }
    assert few.items() <= many.items()


def test_twelve_lenses_have_twelve_colours():
    assert len({lens_colour(i) for i in range(12)}) == 12


def test_the_first_pairs_differ_by_colour_or_dashes():
    pairs = PairStereo().measurements([LENS] * 6)
    assert len({(measurement_colour(pair), measurement_dashes(pair)) for pair in pairs}) == len(pairs) == 15


def test_no_pair_has_the_colour_of_a_lens():
    pairs = {measurement_colour(pair) for pair in PairStereo().measurements([LENS] * 8)}
    assert not pairs & {lens_colour(i) for i in range(12)}


def test_tiers_of_a_lens_differ():
    tiers = LensDefocus().measurements([Lens(6.0, (0.5, 2.0), tiers=4)])
    assert all(measurement_colour(a) != measurement_colour(b) for a, b in combinations(tiers, 2))


@pytest.mark.parametrize(("colour", "ink"), [("#000000", "#ffffff"), ("#ffffff", "#1a1a1a"), ("#ffff00", "#1a1a1a")])
def test_ink_contrasts_with_its_ground(colour, ink):
    assert ink_on(colour) == ink


def test_a_tint_of_one_is_white():
    assert tint("#0072b2", 1.0) == "#ffffff"


def test_style_leaves_nothing_behind():
    before = dict(matplotlib.rcParams)
    with style():
        assert matplotlib.rcParams["svg.hashsalt"] == "multilens"
    assert dict(matplotlib.rcParams) == before
