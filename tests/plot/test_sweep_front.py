import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.cbook import pts_to_poststep

from multilens.plot.labels import Labels
from multilens.plot.style import style
from multilens.plot.sweep_front import FRONT, front, front_figure

POINTS = st.lists(st.tuples(st.integers(0, 8), st.integers(0, 8)), min_size=1, max_size=30)


def error(settings):
    return 100 / float(settings["back.outline.width"]) / int(settings["lenses.count"]) ** 0.5


KEYS = {"back.outline.width": ["30", "40", "60"], "lenses.count": ["2", "3", "4"]}


@given(POINTS)
def test_the_front_is_what_no_other_point_beats(points):
    costs, errors = zip(*points, strict=True)
    beaten = {
        k
        for k, (cost, bad) in enumerate(points)
        if any(a <= cost and b <= bad and (a < cost or b < bad) for a, b in points)
    }
    found = front(costs, errors)
    assert set(found) == set(range(len(points))) - beaten
    assert [costs[k] for k in found] == sorted(costs[k] for k in found)


def fronts(figure):
    return [line.get_xydata() for ax in figure.axes for line in ax.lines if line.get_color() == FRONT]


def test_each_cost_that_varies_has_a_panel_with_its_front(swept):
    figure = front_figure(swept(KEYS, error))
    assert [ax.get_xlabel() for ax in figure.axes] == [
        "area of the back (mm²)",
        "area of all apertures (mm²)",
        "lenses",
    ]
    back, aperture, count = fronts(figure)
    assert np.allclose(back, [[width**2, 100 / width / 2] for width in (30, 40, 60)], rtol=1e-5)
    least = [[lenses, 100 / 60 / lenses**0.5] for lenses in (2, 3, 4)]
    assert np.allclose(count, least, rtol=1e-5)
    assert np.allclose(aperture, np.array(least) * [11.65, 1], rtol=1e-5)


def test_a_cost_that_does_not_vary_has_no_panel(swept):
    figure = front_figure(swept({"lenses.count": ["2", "3"]}, lambda s: 1.0))
    assert [ax.get_xlabel() for ax in figure.axes] == ["area of all apertures (mm²)", "lenses"]
    assert front_figure(swept({"search.seed": ["0", "1"]}, lambda s: 1.0)) is None


def test_every_point_of_the_front_is_labelled_with_its_settings(swept, clear):
    with style():
        figure = front_figure(swept(KEYS, error))
    labels = [{text.get_text() for text in ax.texts} for ax in figure.axes]
    assert labels[0] == {"30 · 4", "40 · 4", "60 · 4"}
    assert labels[1] == labels[2] == {"60 · 2", "60 · 3", "60 · 4"}
    clear(figure)


def test_labels_are_kept_off_the_whole_line_its_last_step_too(swept, monkeypatch):
    kept_off = []
    monkeypatch.setattr(Labels, "rather_not_on", lambda self, places: kept_off.append(places))
    figure = front_figure(swept(KEYS, error))
    for places, line in zip(kept_off, fronts(figure), strict=True):
        np.testing.assert_array_equal(np.transpose(places), pts_to_poststep(*line.T))


def test_jobs_that_share_a_point_share_a_label(swept):
    rows = swept(KEYS | {"search.seed": ["0", "1", "2"]}, error)
    assert "30 · 4 · 0 (+2)" in [text.get_text() for text in front_figure(rows).axes[0].texts]


def test_what_was_asked_is_compared_with_its_like_alone(swept):
    rows = swept(KEYS | {"depth": ["near", "far"]}, lambda s: error(s) * (1 if s["depth"] == "near" else 50))
    figure = front_figure(rows)
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["depth near"] * 3 + ["depth far"] * 3


@pytest.mark.parametrize("many", [3, 15])
def test_labels_keep_apart_however_many_there_are(swept, clear, many):
    widths = [str(30 + width) for width in range(many)]
    rows = swept(
        {"back.outline.width": widths, "a_key.with_a_long_name": ["of_a_value_that_is_very_long", "b"]},
        lambda s: 1 / float(s["back.outline.width"]),
    )
    with style():
        clear(front_figure(rows))
