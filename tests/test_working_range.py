"""Ends of working ranges against closed forms, and against looking at very many depths."""

from math import sqrt

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import Tensor

import multilens as ml
from multilens.cues import Measurement
from multilens.field_of_view import Field
from multilens.fusion import InverseVariance
from multilens.tolerance import Tolerance
from multilens.working_range import WorkingRange, allowed_error, working_range

NOISE, FOCAL_LENGTH, BASELINE, RADIUS = 2e-4, 5.0, 60.0, 1.5
STEREO = (ml.PairStereo(),)
HALVED = 1e-13
"""Relative: what is left of an interval between two depths after halving it to the last bits."""


def pair(*foci: float, cues=STEREO, depths: Tensor | None = None) -> tuple[ml.Problem, ml.Layout]:
    lens = ml.Lens(FOCAL_LENGTH, (RADIUS, RADIUS), disparity_noise=NOISE, blur_noise=NOISE)
    count = max(len(foci), 2)
    place = [[BASELINE * i / (count - 1), 0.0] for i in range(count)]
    problem = ml.Problem(
        ml.Back.rectangle(100, 20),
        [lens] * count,
        ml.log_depths(200, 5000, 64) if depths is None else depths,
        cues=cues,
    )
    return problem, ml.Layout(place, [RADIUS] * count, list(foci) or [300.0] * count)


@pytest.mark.parametrize("mm", [0.1, 1.0, 7.3])
def test_stereo_keeps_a_tolerance_in_mm_up_to_the_root_of_it(mm: float):
    # Z^2 n / (b f) = mm
    end = sqrt(mm * BASELINE * FOCAL_LENGTH / NOISE)
    (found,) = working_range(*pair(), Tolerance(mm=mm)).intervals
    assert found == pytest.approx((200, end), rel=HALVED)


def test_stereo_keeps_a_share_of_the_depth_up_to_a_depth_in_proportion_to_it():
    # Z n / (b f) = share
    (found,) = working_range(*pair(), Tolerance(percent=0.1)).intervals
    assert found == pytest.approx((200, 1e-3 * BASELINE * FOCAL_LENGTH / NOISE), rel=HALVED)


def test_of_two_limits_both_are_kept():
    # Up to 1000 mm a hundredth of the depth is the narrower limit, beyond it 10 mm.
    depths = torch.tensor([200.0, 1000.0, 3000.0])
    assert allowed_error(Tolerance(10, 1), depths).tolist() == [2, 10, 10]


def test_defocus_keeps_a_share_of_the_depth_around_each_focus():
    # |Z - Zf| n / (2 A f) = share, so equally far to both sides.
    reach = 0.01 * 2 * RADIUS * FOCAL_LENGTH / NOISE
    found = working_range(*pair(1000, 4000, cues=[ml.LensDefocus()]), Tolerance(percent=1)).intervals
    assert found == (
        pytest.approx((1000 - reach, 1000 + reach), rel=HALVED),
        pytest.approx((4000 - reach, 4000 + reach), rel=HALVED),
    )


def test_defocus_in_mm_has_a_stretch_near_the_lens_too():
    # Z |Z - Zf| = q: Z^2 - Zf Z + q = 0 has two roots below the focus, Z^2 - Zf Z - q = 0 one beyond it.
    q, focus = 0.5 * 2 * RADIUS * FOCAL_LENGTH / NOISE, 1000.0
    lower, upper = (focus - sqrt(focus**2 - 4 * q)) / 2, (focus + sqrt(focus**2 - 4 * q)) / 2
    beyond = (focus + sqrt(focus**2 + 4 * q)) / 2
    problem, layout = pair(focus, focus, cues=[ml.LensDefocus()], depths=ml.linear_depths(20, 1500, 40))
    found = working_range(problem, layout, Tolerance(mm=0.5)).intervals
    assert found == (pytest.approx((20, lower), rel=HALVED), pytest.approx((upper, beyond), rel=HALVED))


def test_a_gap_between_two_cues_is_seen_however_few_the_depths():
    # Two depths in all: the ends of the range, both within tolerance of their own focus.
    problem, layout = pair(300, 500, cues=[ml.LensDefocus()], depths=torch.tensor([300.0, 500.0]))
    found = working_range(problem, layout, Tolerance(percent=0.01))
    reach = 1e-4 * 2 * RADIUS * FOCAL_LENGTH / NOISE
    assert found.intervals == (pytest.approx((300, 300 + reach)), pytest.approx((500 - reach, 500)))


def test_a_range_that_is_kept_throughout_is_whole():
    found = working_range(*pair(), Tolerance(mm=100))
    assert (found.whole, found.share, found.intervals) == (True, 1, ((200, 5000),))
    assert str(found) == "all of 200 to 5000 mm, error at most 100 mm"


def test_a_tolerance_that_nothing_keeps():
    found = working_range(*pair(), Tolerance(mm=1e-6))
    assert (found.whole, found.share, found.intervals) == (False, 0, ())
    assert str(found) == "nowhere from 200 to 5000 mm is the error at most 1e-06 mm"


def test_stretches_in_words():
    found = WorkingRange(Tolerance(percent=1), 200, 600, ((200, 250), (300, 350)))
    assert str(found) == ("200 to 250 mm, 300 to 350 mm (0.25 of 200 to 600 mm), error at most 1 % of the depth")


def test_a_single_depth_is_in_or_out():
    problem, layout = pair(depths=torch.tensor([1000.0]))
    assert working_range(problem, layout, Tolerance(mm=1)).share == 1
    assert working_range(problem, layout, Tolerance(mm=0.1)).share == 0


def test_depths_beyond_the_problems_own_may_be_asked_for():
    end = sqrt(50 * BASELINE * FOCAL_LENGTH / NOISE)
    found = working_range(*pair(), Tolerance(mm=50), span=(50, 20000))
    assert found.intervals == (pytest.approx((50, end), rel=HALVED),)
    assert (found.near, found.far) == (50, 20000)


class Valley:
    """A cue with a valley and a hill of any width between the depths that are looked at."""

    def __init__(self, at: float, width: float, depth: float) -> None:
        self.at, self.width, self.depth = at, width, depth

    def measurements(self, lenses):
        return (Measurement("valley", (0,), None, "valley"),)

    def __call__(self, layout, lenses, depths):
        return (2 - self.depth / (1 + ((depths - self.at) / self.width) ** 2)).unsqueeze(-2)


def test_a_valley_between_two_depths_is_found():
    # 2 - 1.5 / (1 + x^2) = 1 at x = sqrt(1/2); the depths are 100 / 8 mm apart.
    valley = [Valley(1006, 4, 1.5)]
    found = working_range(*pair(cues=valley, depths=ml.linear_depths(500, 1500, 11)), Tolerance(mm=1)).intervals
    reach = 4 * sqrt(0.5)
    assert found == (pytest.approx((1006 - reach, 1006 + reach), rel=1e-9),)


def test_a_hill_between_two_depths_is_found():
    # 2 + 1.5 / (1 + x^2) = 3 at x = sqrt(1/2)
    hill = [Valley(1006, 4, -1.5)]
    found = working_range(*pair(cues=hill, depths=ml.linear_depths(500, 1500, 11)), Tolerance(mm=3)).intervals
    reach = 4 * sqrt(0.5)
    assert found == (pytest.approx((500, 1006 - reach)), pytest.approx((1006 + reach, 1500)))


class Masked(Valley):
    """Stereo that fails below a depth: infinite errors."""

    def __call__(self, layout, lenses, depths):
        return torch.where(depths < self.at, torch.inf, depths * 1e-3).unsqueeze(-2)


def test_a_cue_that_fails_begins_where_it_begins_to_measure():
    found = working_range(*pair(cues=[Masked(777.7, 0, 0)]), Tolerance(mm=2)).intervals
    assert found == (pytest.approx((777.7, 2000), rel=HALVED),)


@given(
    foci=st.lists(st.floats(250, 4900), min_size=2, max_size=4),
    tolerance=st.builds(Tolerance, st.none() | st.floats(0.05, 50), st.floats(0.01, 5)),
)
def test_the_stretches_are_what_looking_at_very_many_depths_says(foci: list[float], tolerance: Tolerance):
    problem, layout = pair(*foci, cues=[ml.PairStereo(), ml.LensDefocus()])
    many = torch.linspace(200, 5000, 20001, dtype=torch.float64)
    errors = torch.cat([cue(layout, problem.lenses, many) for cue in problem.cues])
    kept = (errors.amin(0) <= allowed_error(tolerance, many)).tolist()
    found = working_range(problem, layout, tolerance)
    slack = 1e-9 * 5000
    for depth, within in zip(many.tolist(), kept, strict=True):
        near_an_end = any(abs(depth - end) < slack for stretch in found.intervals for end in stretch)
        assert near_an_end or within == any(near <= depth <= far for near, far in found.intervals)


def test_measurements_together_reach_farther_than_the_best_of_them():
    # Three lenses evenly on a line: by N views the squared distances from their mean count, b^2 / 2, as for one pair.
    # With two more cues of the same error e the error of all is e / sqrt(3).
    class Twin(Valley):
        def __call__(self, layout, lenses, depths):
            return (depths * 1e-3).unsqueeze(-2)

    problem, layout = pair(cues=[Twin(0, 0, 0)] * 3)
    together = ml.Problem(problem.back, problem.lenses, problem.depths, cues=problem.cues, fusion=InverseVariance())
    assert working_range(problem, layout, Tolerance(mm=1)).intervals == (pytest.approx((200, 1000), rel=HALVED),)
    assert working_range(together, layout, Tolerance(mm=1)).intervals == (
        pytest.approx((200, 1000 * sqrt(3)), rel=HALVED),
    )


def test_the_tolerance_is_kept_in_every_part_of_the_field():
    # Both lenses see what lies straight ahead; 30 degrees to the side only the first, whose focus is at 1000 mm.
    wide = ml.Lens(FOCAL_LENGTH, (RADIUS, RADIUS), blur_noise=NOISE, disparity_noise=NOISE, field_of_view_deg=90)
    tele = ml.Lens(FOCAL_LENGTH, (RADIUS, RADIUS), blur_noise=NOISE, disparity_noise=NOISE, field_of_view_deg=20)
    problem, layout = pair(1000, 4000, cues=[ml.LensDefocus()])
    seen = ml.Problem(problem.back, [wide, tele], problem.depths, cues=problem.cues, field=Field((0, 30), (1, 1)))
    reach = 0.01 * 2 * RADIUS * FOCAL_LENGTH / NOISE
    found = working_range(seen, layout, Tolerance(percent=1)).intervals
    assert found == (pytest.approx((1000 - reach, 1000 + reach), rel=HALVED),)
