from pathlib import Path

import pytest
import torch

import multilens.plot
from multilens.convergence import Convergence
from multilens.disturbance import Disturbance
from multilens.field_of_view import Field
from multilens.layout import Layout
from multilens.plot.figures import design_figures, overview_figure, save_figures, title, warning
from multilens.problem import Problem
from multilens.robust import Robust

CONVERGENCE = Convergence((0, 5), torch.tensor([[100.0, 25.0]]), (0,), (16.0,))


def all_words(figure):
    from matplotlib.text import Text

    return [text for text in figure.findobj(Text) if text.get_text() and text.get_visible()]


def test_each_picture_has_its_key(cases):
    assert list(design_figures(*cases["phone 2"], CONVERGENCE)) == ["layout", "errors", "convergence"]


def test_without_depths_or_a_search_the_back_is_left(cases):
    assert list(design_figures(*cases["unit square"], None)) == ["layout"]


def test_the_overview_is_a_slide(cases):
    width, height = overview_figure(*cases["phone 2"]).get_size_inches()
    assert width / height == pytest.approx(16 / 9, rel=1e-3)


@pytest.mark.parametrize("name", ["phone 12", "island 8", "tiers", "thesis line", "unit square"])
def test_nothing_of_the_overview_is_cut(cases, name):
    figure = overview_figure(*cases[name])
    figure.draw_without_rendering()
    whole = figure.bbox
    for text in all_words(figure):
        box = text.get_window_extent()
        assert box.x0 >= 0, text
        assert box.y0 >= 0, text
        assert box.x1 <= whole.x1, text
        assert box.y1 <= whole.y1, text


def test_the_same_figure_gives_the_same_bytes(cases, tmp_path):
    written = []
    for folder in (tmp_path / "once", tmp_path / "again"):
        folder.mkdir()
        paths = save_figures({"layout": design_figures(*cases["unit square"])["layout"]}, folder)
        written.append([path.read_bytes() for path in paths])
    assert written[0] == written[1]


def test_files_are_named_for_their_figures(cases, tmp_path):
    paths = save_figures({"back": design_figures(*cases["unit square"])["layout"]}, tmp_path)
    assert [path.name for path in paths] == ["back.svg", "back.png"]
    assert paths[0].read_text().startswith("<?xml")
    assert paths[1].read_bytes().startswith(b"\x89PNG")


def test_the_title_says_how_well_the_lenses_do(cases):
    problem, layout = cases["phone 4"]
    assert title(problem, layout) == f"4 lenses, RMSE {problem.score(layout).sqrt().item():.2f} mm over 0.20 to 5.00 m"


def test_the_title_says_where_the_score_is_over_a_field(cases):
    problem, layout = cases["phone 2"]
    field = Problem(problem.back, problem.lenses, problem.depths, field=Field.rings(60, 2))
    assert title(field, layout).endswith(" over 0.20 to 5.00 m and the field")


def test_pictures_of_a_question_of_many_devices_tell_what_is_as_drawn(cases):
    problem, layout = cases["phone 2"]
    figures = design_figures(Robust(problem, Disturbance(covered=1), level=0.9), layout, CONVERGENCE)
    assert {word.get_text().split(",")[0] for word in figures["layout"].texts} == {"2 lenses as drawn"}
    assert figures["convergence"].axes[0].get_ylabel() == "RMSE of the worst 10 % of devices (mm)"


def test_a_layout_that_breaks_a_constraint_is_not_shown_as_a_design(cases):
    problem, _ = cases["disc"]
    together = Layout([(0, 0), (1, 0), (20, 0)], [1.93] * 3, [500.0] * 3)
    assert warning(problem, together) == "not feasible: lens 1 to lens 2 lacks 8.86 mm"


def test_a_feasible_layout_has_no_warning(cases):
    assert warning(*cases["disc"]) == ""


def test_nothing_here_touches_the_state_of_pyplot():
    sources = [path.read_text() for path in Path(multilens.plot.__file__).parent.glob("*.py")]
    assert not [source for source in sources if "pyplot" in source]
