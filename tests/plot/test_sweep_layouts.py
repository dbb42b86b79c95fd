import numpy as np
import pytest
from matplotlib.patches import Circle

from multilens.plot.canvas import POINTS_PER_INCH
from multilens.plot.style import style
from multilens.plot.sweep_layouts import MOST, caption, columns_of, layouts_figure, shown
from multilens.sweep_row import SweepRow


@pytest.fixture
def sweep(swept, cases):
    """Six jobs: 2 and 4 lenses on the back of a phone and on an island, of which one found nothing; and what was found."""
    names = {("phone", "2"): "phone 2", ("phone", "4"): "phone 4", ("island", "2"): "island 2"}
    rows = swept(
        {"back": ["phone", "island"], "lenses.count": ["2", "4", "9"]},
        lambda s: 1.0 if (s["back"], s["lenses.count"]) in names else "infeasible",
    )
    answers = {row.job: cases[names[row.settings[0][1], row.settings[1][1]]] for row in rows if row.figure is not None}
    return rows, answers


def test_all_layouts_have_one_scale(sweep):
    rows, answers = sweep
    figure = layouts_figure(rows, answers)
    scales = []
    for ax in figure.axes:
        discs = [patch for patch in ax.patches if isinstance(patch, Circle)]
        if discs:
            pixels = ax.transData.transform([(0, 0), (1, 0), (0, 1)])
            scales += [np.hypot(*(pixels[k] - pixels[0])) / figure.dpi * POINTS_PER_INCH for k in (1, 2)]
    assert len(scales) == 2 * len(answers)
    assert np.allclose(scales, scales[0])


def test_a_layout_is_drawn_lens_by_lens(sweep):
    rows, answers = sweep
    drawn = [ax for ax in layouts_figure(rows, answers).axes if any(isinstance(p, Circle) for p in ax.patches)]
    for ax, (_, layout) in zip(drawn, answers.values(), strict=True):
        discs = [patch for patch in ax.patches if isinstance(patch, Circle)]
        centres = sorted({tuple(disc.center) for disc in discs})
        assert np.allclose(centres, sorted(map(tuple, layout.position.tolist())))


def test_nothing_is_cut_and_captions_keep_apart(sweep, clear):
    with style():
        clear(layouts_figure(*sweep))


def test_a_job_without_a_layout_says_so(sweep):
    words = [text.get_text() for ax in layouts_figure(*sweep).axes for text in ax.texts]
    assert words.count("2: infeasible") == 1


def test_a_job_whose_design_cannot_be_read_says_so_and_no_error(sweep):
    rows, answers = sweep
    words = [text.get_text() for ax in layouts_figure(rows, answers).axes for text in ax.texts]
    assert "1: 1.00 mm" in words
    left = {job: answer for job, answer in answers.items() if job != 1}
    words = [text.get_text() for ax in layouts_figure(rows, left).axes for text in ax.texts]
    assert "1: unreadable" in words
    assert "1: 1.00 mm" not in words


def test_a_caption_tells_job_error_and_settings():
    row = SweepRow(7, (("depth", "room"), ("lenses.count", "3")), "complete", figure=1.2345, unit="mm")
    assert caption(row, {"lenses.count": "count"}) == ["7: 1.23 mm", "count 3"]


def test_without_any_layout_there_is_no_picture(sweep):
    assert layouts_figure(sweep[0], {}) is None


def test_of_too_many_those_are_shown_that_no_other_beats(swept):
    rows = swept(
        {"search.seed": [str(k) for k in range(2 * MOST)], "lenses.count": ["2", "3"]},
        lambda s: 1 + int(s["search.seed"]) % 7,
    )
    rows[-1] = SweepRow(**(vars(rows[-1]) | {"figure": 0.5}))
    kept = shown(rows)
    assert len(kept) == MOST
    assert kept[-1] is rows[-1]
    assert [row.job for row in kept] == sorted(row.job for row in kept)


@pytest.mark.parametrize(
    ("keys", "columns"),
    [
        ({}, 1),
        ({"a": 2}, 2),
        ({"a": 4}, 4),
        ({"a": 6, "b": 8}, 8),
        ({"a": 9, "b": 4}, 8),
        ({"a": 3, "b": 2}, 6),
        ({"a": 30}, 8),
    ],
)
def test_the_fastest_key_goes_across(swept, keys, columns):
    rows = swept({key: [str(k) for k in range(number)] for key, number in keys.items()}, lambda s: 1.0)
    assert columns_of(rows) == columns
