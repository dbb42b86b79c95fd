"""Tables against looking through every node."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from multilens.bounds.tables import SavingsTable, best_price


@given(st.integers(0, 2**31), st.integers(1, 40))
def test_the_most_of_a_stretch_is_that_of_its_nodes_and_what_lies_between(seed, nodes):
    random = np.random.default_rng(seed)
    saved, area = np.sort(random.uniform(0, 1, nodes)), np.sort(random.uniform(0, 1, nodes))
    prices = np.array([0.0, 0.7])
    low = random.integers(0, nodes, 20)
    high = np.array([random.integers(first, nodes) for first in low])
    found = SavingsTable.of(saved, area, prices).most(low[:, None], high[:, None])[:, :, 0]
    for box, (first, last) in enumerate(zip(low, high, strict=True)):
        for index, price in enumerate(prices):
            exact = [saved[min(k + 1, last)] - price * area[k] for k in range(first, max(last, first + 1))]
            assert found[index, box] == max(exact)


def test_the_price_shares_the_room_out():
    area = np.linspace(0.1, 4, 391)
    # Two lenses that each save the root of their area share 2 mm^2: 1 each, where saving grows by 1/2 for each mm^2.
    price = best_price([np.sqrt(area)], [area], [2], 2.0)
    assert abs(price / 0.5 - 1) < 0.1


def test_where_there_is_room_enough_it_has_no_price():
    area = np.linspace(0.1, 4, 40)
    assert best_price([np.sqrt(area)], [area], [2], 9.0) == 0
