"""Pairs against SciPy's list of distances, and their gradient where two centres coincide."""

import torch
from scipy.spatial.distance import pdist
from torch.autograd import gradcheck

from multilens.geometry.pairs import pair_distance, pair_indices


def test_pairs_are_in_the_order_of_their_first_member():
    assert pair_indices(4).T.tolist() == [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]


def test_one_lens_makes_no_pair():
    assert pair_distance(torch.zeros(7, 1, 2)).shape == (7, 0)


def test_distances_agree_with_scipy():
    position = torch.rand(5, 6, 2, dtype=torch.float64, generator=torch.Generator().manual_seed(0))
    expected = torch.stack([torch.from_numpy(pdist(one.numpy())) for one in position])
    torch.testing.assert_close(pair_distance(position), expected, rtol=1e-14, atol=0)


def test_gradient():
    position = torch.rand(4, 2, dtype=torch.float64, generator=torch.Generator().manual_seed(0)).requires_grad_()
    assert gradcheck(pair_distance, position)


def test_coincident_centres_have_the_gradient_zero():
    position = torch.ones(2, 2, requires_grad=True)
    pair_distance(position).sum().backward()
    assert position.grad is not None
    assert position.grad.tolist() == [[0.0, 0.0], [0.0, 0.0]]
