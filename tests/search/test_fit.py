import pytest
from hypothesis import given
from hypothesis import strategies as st

import multilens as ml
from multilens.search import fit
from multilens.search.fit import why_nothing_fits


def question(back: ml.Back, *lenses: ml.Lens, gap: float = 0.0) -> ml.ScoreProblem:
    return ml.ScoreProblem(back, lenses, lambda layout: -layout.aperture_radius, gap)


def test_a_lens_wider_than_the_back() -> None:
    reason = why_nothing_fits(question(ml.Back.rectangle(10, 4), ml.Lens(1.0, (1.0, 2.0), clearance=1.1)))
    assert reason is not None
    assert "lens 1 needs a disc of radius 2.1 mm" in reason


def test_a_lens_that_just_fits() -> None:
    for back in (ml.Back.rectangle(10, 4), ml.Back.disc(2.0), ml.Back.rounded_rectangle(10, 4, 2)):
        assert why_nothing_fits(question(back, ml.Lens(1.0, (1.0, 2.0), clearance=1.0))) is None


def test_more_area_than_there_is() -> None:
    reason = why_nothing_fits(question(ml.Back.rectangle(10, 10), *[ml.Lens(1.0, (2.0, 2.0))] * 8))
    assert reason is not None
    assert "the 8 bodies need 100.5 mm^2" in reason


def test_a_keep_out_over_everything() -> None:
    back = ml.Back.rectangle(10, 10).keep_out("battery", ml.rectangle(11, 11, centre=(5, 5)))
    assert why_nothing_fits(question(back, ml.Lens(1.0, (0.1, 1.0)))) == "the keep-outs cover the whole back"


def test_locked_lenses_too_close() -> None:
    lenses = [ml.Lens(1.0, (1.0, 2.0), position=(x, 5.0)) for x in (3.0, 5.2)]
    assert why_nothing_fits(question(ml.Back.rectangle(10, 10), *lenses)) is None
    reason = why_nothing_fits(question(ml.Back.rectangle(10, 10), *lenses, gap=0.5))
    assert reason == "lenses 1 and 2 are locked 2.2 mm apart and need 2.5 mm"


def test_a_locked_lens_on_a_keep_out() -> None:
    back = ml.Back.rectangle(10, 10).keep_out("flash", ml.disc((5.0, 5.0), 1.0))
    reason = why_nothing_fits(question(back, ml.Lens(1.0, (1.0, 2.0), position=(6.5, 5.0))))
    assert reason == "lens 1 is locked where 0.5 mm are free around it and needs 1 mm"


@pytest.mark.parametrize("count", [2, 3, 5, 7, 9])
def test_the_best_known_packings_are_never_refused(count: int) -> None:
    # Published radii of equal circles in the unit square: they do fit.
    radius = {2: 0.292893218813, 3: 0.25433309503, 5: 0.207106781187, 7: 0.174457630187, 9: 0.166666666667}[count]
    assert why_nothing_fits(question(ml.Back.rectangle(1, 1), *[ml.Lens(1.0, (radius, radius))] * count)) is None


def test_no_largest_disc_is_sought_where_there_is_room(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("sought")

    monkeypatch.setattr(fit, "maximum_inscribed_circle", refuse)
    back = ml.Back.rounded_rectangle(70, 150, 10).keep_out("logo", ml.disc((35.0, 80.0), 25.0), clearance=1.0)
    assert why_nothing_fits(question(back, *[ml.Lens(1.0, (1.0, 2.0), clearance=6.0)] * 4)) is None


@given(st.integers(0, 2**31), st.floats(0.5, 15), st.integers(1, 12))
def test_a_few_looks_never_answer_other_than_the_largest_disc_and_the_area(
    random_region, seed: int, radius: float, count: int
) -> None:
    back = ml.Back(random_region(seed)).keep_out("flash", ml.disc((0.0, 0.0), 4.0), clearance=3.0)
    asked = question(back, *[ml.Lens(1.0, (radius, radius))] * count)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(fit, "_plainly_spacious", lambda *_: False)
        thorough = why_nothing_fits(asked)
    assert why_nothing_fits(asked) == thorough


def test_more_area_than_a_keep_out_and_its_clearance_leave() -> None:
    back = ml.Back.rectangle(20, 10).keep_out("battery", ml.rectangle(8, 30, centre=(4.0, 5.0)), clearance=2.0)
    reason = why_nothing_fits(question(back, *[ml.Lens(1.0, (2.0, 2.0))] * 8))
    assert reason is not None
    assert "the 8 bodies need 100.5 mm^2" in reason
