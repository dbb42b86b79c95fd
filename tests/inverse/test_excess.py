import pytest
import torch

import multilens as ml
from multilens.inverse.excess import Excess


def test_the_figure_is_how_many_times_what_is_allowed_the_largest_error_is():
    # Errors are Z^2 n / (b f) = Z^2 / 1e5: 0.4, 3.6 and 10 mm, of 1 % of the depth, 5 mm at most, i.e. of 2, 5 and 5 mm.
    lens = ml.Lens(5.0, (1.0, 1.0), disparity_noise=1e-3)
    depths = torch.tensor([200.0, 600.0, 1000.0])
    metric = Excess(ml.Tolerance(mm=5, percent=1))
    problem = ml.Problem(ml.Back.rectangle(110, 10), [lens] * 2, depths, cues=[ml.PairStereo()], metric=metric)
    layout = ml.Layout([[5, 5], [25, 5]], [1, 1], [300, 300])
    assert metric.figure(problem.score(layout).item()) == pytest.approx(2.0, rel=1e-12)
