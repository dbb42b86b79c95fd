"""A question with a score of one's own."""

from torch import Tensor

from multilens import Back, Layout, Lens, ScoreProblem

BACK = Back.rectangle(70, 150)
LENSES = [Lens(6.0, (0.5, 2.0))] * 2
LAYOUTS = Layout(
    [[[10.0, 20.0], [30.0, 40.0]], [[1.0, 2.0], [3.0, 5.0]]], [[1.0, 2.0], [1.5, 0.5]], [[1.0, 1.0], [1.0, 1.0]]
)


def by_radius(layout: Layout) -> Tensor:
    return -layout.aperture_radius


def test_of_several_terms_the_largest_is_the_score():
    assert ScoreProblem(BACK, LENSES, by_radius).score(LAYOUTS).tolist() == [-1.0, -0.5]


def test_a_score_of_one_number_is_one_term():
    problem = ScoreProblem(BACK, LENSES, lambda layout: layout.position.sum((-1, -2)))
    assert problem.terms(LAYOUTS).tolist() == [[100.0], [11.0]]


def test_it_has_a_unit_of_its_own():
    assert ScoreProblem(BACK, LENSES, by_radius).metric is None
