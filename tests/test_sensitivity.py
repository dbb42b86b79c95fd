"""What it costs that a lens is off, against closed forms and differences."""

import pytest
import torch

from multilens import (
    Back,
    Layout,
    Lens,
    LensDefocus,
    LimitedStereo,
    PairLimits,
    PairStereo,
    Problem,
    linear_depths,
)
from multilens.metrics import Relative, WorstCase
from multilens.sensitivity import Sensitivity, sensitivity

LENS = Lens(6.0, (0.5, 3.0), disparity_noise=0.0003, blur_noise=0.0003)
DEPTHS = linear_depths(300, 2000, 64)
BACK = Back.rectangle(60, 60)
PAIR = Problem(BACK, [LENS] * 2, DEPTHS, cues=[PairStereo()])
APART = Layout([[10.0, 10.0], [22.0, 26.0]], [2.0, 2.0], [800.0, 800.0])  # a baseline of 20 mm


def test_a_pair_that_comes_closer_by_a_tenth_of_a_millimetre_measures_as_much_worse():
    told = sensitivity(PAIR, APART)
    expected = told.figure * (20 / 19.9 - 1)
    for row in told.lenses:
        # The direction is within 2.5 degrees of the baseline's.
        assert row.shift.worst == pytest.approx(expected, rel=2e-3)
        assert row.shift.slope == pytest.approx(told.figure * 0.1 / 20, rel=1e-9)
        assert not row.shift.kink


def test_a_shift_that_nobody_knows_makes_an_error_of_the_depth_times_its_part_of_the_baseline():
    (first, second) = sensitivity(PAIR, APART).lenses
    expected = (DEPTHS.square().mean().sqrt() * 0.1 / 20).item()
    assert first.unknown_shift == pytest.approx(expected, rel=1e-9)
    assert second.unknown_shift == pytest.approx(expected, rel=1e-9)


def test_a_lens_over_its_sensor_makes_the_error_of_its_disparity():
    expected = (DEPTHS**2 / 20 * (0.001 / 6 + 0.001 / DEPTHS)).square().mean().sqrt().item()
    assert sensitivity(PAIR, APART).lenses[0].unknown_decentre == pytest.approx(expected, rel=1e-9)


def test_the_worst_of_the_depths_is_told_where_that_is_asked_for():
    worst = Problem(BACK, [LENS] * 2, DEPTHS, cues=[PairStereo()], metric=WorstCase())
    assert sensitivity(worst, APART).lenses[0].unknown_shift == pytest.approx(2000 * 0.1 / 20, rel=1e-9)


def test_relative_errors_are_told_in_per_cent():
    told = sensitivity(Problem(BACK, [LENS] * 2, DEPTHS, cues=[PairStereo()], metric=Relative()), APART)
    assert told.unit == "%"
    assert told.lenses[0].unknown_shift == pytest.approx(0.5, rel=1e-9)  # 0.1 mm of 20 mm


def test_defocus_alone_gets_worse_as_its_aperture_closes():
    alone = Problem(BACK, [LENS], DEPTHS, cues=[LensDefocus()])
    told = sensitivity(alone, Layout([[30.0, 30.0]], [2.0], [1500.0]))
    (row,) = told.lenses
    assert row.aperture.worst == pytest.approx(told.figure * (1 / 0.99 - 1), rel=1e-9)
    assert row.aperture.slope == pytest.approx(told.figure * 0.01, rel=1e-9)
    assert row.unknown_shift == 0
    assert row.covered is None
    assert "all" in str(told)


def test_the_focus_of_defocus_alone_follows_its_parabola():
    alone = Problem(BACK, [LENS], DEPTHS, cues=[LensDefocus()])
    told = sensitivity(alone, Layout([[30.0, 30.0]], [2.0], [1500.0]))

    def figure(focus: float) -> float:
        return (DEPTHS * (DEPTHS - focus) * 0.0003 / (2 * 2.0 * 6.0)).square().mean().sqrt().item()

    either_way = (figure(1 / (1 / 1500 + sign * 1e-5)) for sign in (-1, 1))
    assert told.lenses[0].focus.worst == pytest.approx(max(either_way) - figure(1500), rel=1e-9)
    slope = abs(figure(1 / (1 / 1500 + 1e-8)) - figure(1 / (1 / 1500 - 1e-8))) / 2e-8 * 1e-5
    assert told.lenses[0].focus.slope == pytest.approx(slope, rel=1e-5)


def test_two_pairs_of_equal_baseline_are_a_corner_and_the_table_says_so():
    square = Layout([[10.0, 10.0], [30.0, 10.0], [10.0, 30.0], [30.0, 30.0]], [2.0] * 4, [800.0] * 4)
    told = sensitivity(Problem(BACK, [LENS] * 4, DEPTHS, cues=[PairStereo()]), square)
    # If one diagonal gets shorter, the other is as good as ever; the gradient sees one of them.
    assert [row.shift.worst for row in told.lenses] == [0] * 4
    assert sum(row.shift.slope > 0 for row in told.lenses) == 2
    assert all(row.shift.kink == (row.shift.slope > 0) for row in told.lenses)
    assert "corner" in str(told)


def test_a_covered_lens_costs_what_the_others_lack():
    three = Problem(BACK, [LENS] * 3, DEPTHS, cues=[PairStereo()])
    layout = Layout([[10.0, 10.0], [30.0, 10.0], [15.0, 10.0]], [2.0] * 3, [800.0] * 3)
    told = sensitivity(three, layout)
    covered = [row.covered for row in told.lenses]
    assert covered[0] == pytest.approx(told.figure * (20 / 15 - 1), rel=1e-9)
    assert covered[1] == pytest.approx(told.figure * (20 / 5 - 1), rel=1e-9)
    assert covered[2] == pytest.approx(0, abs=1e-12)


def test_the_table_has_a_row_for_each_lens_and_a_number_in_every_cell():
    head, *rows = sensitivity(PAIR, APART).cells()
    assert [row[0] for row in rows] == [1, 2]
    assert {len(row) for row in rows} == {len(head)}


def test_a_layout_is_left_as_it_was():
    before = [part.clone() for part in vars(APART).values()]
    assert isinstance(sensitivity(PAIR, APART), Sensitivity)
    assert all(torch.equal(a, b) for a, b in zip(before, vars(APART).values(), strict=True))


def test_what_nobody_knows_makes_no_error_where_nothing_measures():
    # 20 mm apart they measure from 1000 mm on; what lies nearer is guessed.
    limited = LimitedStereo(PairLimits(max_disparity=0.12))
    told = sensitivity(Problem(BACK, [LENS] * 2, DEPTHS, cues=[limited]), APART)
    measured = DEPTHS.where(DEPTHS >= 1000, 0)
    expected = (measured.square().mean().sqrt() * 0.1 / 20).item()
    assert told.lenses[0].unknown_shift == pytest.approx(expected, rel=1e-9)
