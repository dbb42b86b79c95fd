import pytest

from multilens.plot.figures import save_figures
from multilens.plot.sweep_figures import sweep_figures

COUNTS = ["1", "2", "4"]


def drawn(rows, cases):
    answers = {row.job: cases[f"island {row.lens_count}"] for row in rows if row.figure is not None}
    return sweep_figures(rows, answers)


@pytest.mark.parametrize(
    ("keys", "pictures"),
    [
        ({"lenses.count": COUNTS}, ["count", "layouts", "front"]),
        ({"lenses.count": ["2"]}, ["layouts"]),
        ({"search.seed": ["0", "1"]}, ["layouts"]),
        ({"search.seed": ["0", "1"], "depth": ["near", "far"]}, ["layouts"]),
        ({"search.seed": ["0", "1"], "search.patience": ["0", "1"]}, ["layouts", "map"]),
        ({"lenses.count": COUNTS, "back.outline.width": ["30", "40"]}, ["count", "layouts", "front", "map"]),
    ],
)
def test_a_sweep_has_the_pictures_that_make_sense_for_it(swept, cases, keys, pictures):
    assert list(drawn(swept(keys, lambda s: 1.0), cases)) == pictures


def test_a_sweep_that_found_nothing_has_none(swept, cases):
    assert drawn(swept({"lenses.count": COUNTS}, lambda s: "infeasible"), cases) == {}
    assert drawn([], cases) == {}


def test_the_same_sweep_gives_the_same_bytes(swept, cases, tmp_path, monkeypatch):
    monkeypatch.setattr("multilens.plot.figures.DOTS_PER_INCH", 40)
    rows = swept({"lenses.count": COUNTS, "back.outline.width": ["30", "40"]}, lambda s: 4 / int(s["lenses.count"]))
    written = []
    for folder in (tmp_path / "once", tmp_path / "again"):
        folder.mkdir()
        written.append([path.read_bytes() for path in save_figures(drawn(rows, cases), folder)])
    assert written[0] == written[1]
