import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from matplotlib.patches import Rectangle

from multilens.plot.style import style
from multilens.plot.sweep_map import axes_of_the_map, map_figure

KEYS = {"lenses.count": ["10", "2"], "back.outline.width": ["30", "40", "60"]}


def error(settings):
    return float(settings["back.outline.width"]) / int(settings["lenses.count"])


def cells(ax):
    (mesh,) = (each for each in ax.collections if isinstance(each, QuadMesh))
    return mesh.get_array()


def maps(figure):
    return [ax for ax in figure.axes if any(isinstance(each, QuadMesh) for each in ax.collections) and ax.get_xlabel()]


def test_a_cell_has_the_error_of_its_values_in_their_order(swept):
    (ax,) = maps(map_figure(swept(KEYS, error)))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("width", "count")
    assert np.allclose(cells(ax), [[15, 20, 30], [3, 4, 6]])
    assert [text.get_text() for text in ax.get_yticklabels()] == ["2", "10"]
    assert {text.get_text() for text in ax.texts} == {"15.0", "20.0", "30.0", "3.00", "4.00", "6.00"}


def test_a_job_without_a_design_is_hatched_and_said(swept):
    rows = swept(KEYS, lambda s: "failed" if s == {"lenses.count": "2", "back.outline.width": "60"} else error(s))
    (ax,) = maps(map_figure(rows))
    (hatched,) = (patch for patch in ax.patches if isinstance(patch, Rectangle))
    assert hatched.get_xy() == (2, 0)
    assert "failed" in {text.get_text() for text in ax.texts}
    assert np.ma.getmaskarray(cells(ax)).sum() == 1


def test_other_keys_have_a_map_for_each_of_their_settings(swept):
    figure = map_figure(swept(KEYS | {"depth": ["near", "far"], "search.seed": ["0", "1"]}, error))
    assert [ax.get_title(loc="left") for ax in maps(figure)] == [
        f"depth {depth}, seed {seed}" for depth in ("near", "far") for seed in ("0", "1")
    ]


def test_unlike_units_never_share_a_map(swept):
    units = {"mean_square": ("RMSE", "mm"), "relative": ("relative RMSE", "%")}
    rows = swept(KEYS | {"metric": list(units)}, error, lambda s: units[s["metric"]])
    assert [ax.get_title(loc="left") for ax in maps(map_figure(rows))] == ["metric mean_square", "metric relative"]
    pair = swept({"metric": list(units), "lenses.count": ["1", "2"]}, lambda s: 1.0, lambda s: units[s["metric"]])
    assert map_figure(pair) is None


@pytest.mark.parametrize(
    ("keys", "pair"),
    [
        ({"depth": ["a", "b"], "lenses.count": ["1", "2"]}, None),
        ({"depth.far": ["2000", "3000"], "depth.near": ["200", "300"]}, None),
        ({"depth": ["a", "b"], "back": ["a", "b"], "lenses.count": ["1", "2", "3"]}, ("lenses.count", "back")),
        (
            {"search.seed": ["0", "1", "2", "3"], "back": ["a", "b"], "lenses.count": ["1", "2"]},
            ("back", "lenses.count"),
        ),
        ({"lenses.count": ["1", "2"]}, None),
    ],
)
def test_what_belongs_to_the_device_comes_first(swept, keys, pair):
    assert axes_of_the_map(swept(keys, lambda s: 1.0)) == pair


def test_there_is_no_map_of_numbers_that_were_chosen_freely(swept):
    numbers = [f"{30 + k / 7:.4f}" for k in range(12)]
    rows = swept({"back.outline.width": numbers, "lenses.lens.f_number.0": numbers}, lambda s: 1.0)
    assert map_figure(rows) is not None
    assert map_figure([rows[13 * k] for k in range(12)]) is None


@pytest.mark.parametrize("many", [2, 20])
def test_words_keep_apart_however_many_and_long_values_are(swept, clear, many):
    values = [f"a_value_that_is_very_long_{k}" for k in range(many)]
    rows = swept({"back": values, "lenses": values[: many // 2 + 1], "depth": ["a", "b"]}, lambda s: 1.0 + len(s))
    with style():
        clear(map_figure(rows))
