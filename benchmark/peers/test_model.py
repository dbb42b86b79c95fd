import numpy as np
import pytest

from benchmark.peers.model import Model
from benchmark.problems import CASES
from multilens.search.legalise import legalise


@pytest.fixture(params=CASES, ids=lambda case: case.name)
def model(request: pytest.FixtureRequest) -> Model:
    return Model(request.param.problem)


def test_the_score_is_the_librarys(model: Model) -> None:
    vectors = model.random_starts(np.random.default_rng(1), 4)
    library = [model.problem.score(model.layout(v)).item() for v in vectors]
    np.testing.assert_allclose(model.score(vectors), library, rtol=1e-9)


def test_what_lacks_nothing_is_feasible_by_the_exact_certificate(model: Model) -> None:
    settled, missing = model.settle(model.random_starts(np.random.default_rng(2), 12))
    fits = settled[missing == 0][:2]
    assert all(legalise(model.problem, model.layout(v))[1].feasible for v in fits)


def test_what_lacks_a_tenth_of_a_millimetre_is_not(model: Model) -> None:
    anywhere = np.random.default_rng(3).uniform(size=(12, len(model.upper))) * model.upper
    settled, missing = model.settle(anywhere)
    lacking = settled[missing > 0.1][:2]
    assert not any(legalise(model.problem, model.layout(v))[1].feasible for v in lacking)


def test_a_vector_is_split_and_joined(model: Model) -> None:
    v = model.random_starts(np.random.default_rng(4), 1)[0]
    np.testing.assert_allclose(model.join(*model.split(v)), v, atol=1e-12)
