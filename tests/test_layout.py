"""Layouts: what a layout may be made of, and what is refused."""

import pytest
import torch

from multilens import Layout


def test_lists_become_double_precision():
    layout = Layout([[1, 2], [3, 4]], [1, 1], [100, 200])
    assert {t.dtype for t in (layout.position, layout.aperture_radius, layout.focus)} == {torch.float64}


def test_whole_numbers_in_a_tensor_become_double_precision():
    assert Layout(torch.tensor([[1, 2]]), torch.tensor([1]), torch.tensor([100])).position.dtype == torch.float64


def test_floating_point_type_of_tensors_is_kept():
    single = Layout(torch.zeros(1, 2), torch.ones(1), torch.ones(1))
    assert single.position.dtype == torch.float32


def test_focus_without_tiers_is_one_tier():
    assert Layout([[0.0, 0.0], [1.0, 0.0]], [1.0, 1.0], [5.0, 6.0]).focus.tolist() == [[5.0], [6.0]]


def test_gradient_reaches_the_tensors_handed_in():
    position = torch.zeros(2, 2, requires_grad=True)
    Layout(position, torch.ones(2), torch.ones(2)).position.sum().backward()
    assert position.grad is not None


@pytest.mark.parametrize("batch", [(3,), (2, 3)])
def test_an_index_picks_from_the_batch(batch):
    layout = Layout(torch.rand(*batch, 4, 2), torch.rand(*batch, 4), torch.rand(*batch, 4, 2))
    assert layout[1].position.equal(layout.position[1])
    assert layout[1].aperture_radius.equal(layout.aperture_radius[1])
    assert layout[1].focus.equal(layout.focus[1])


def test_a_mask_picks_from_the_batch():
    layout = Layout(torch.rand(3, 4, 2), torch.rand(3, 4), torch.rand(3, 4, 1))
    assert layout[torch.tensor([True, False, True])].position.equal(layout.position[[0, 2]])


def test_only_picks_lenses_of_every_layout():
    layout = Layout(torch.rand(4, 3, 2), torch.rand(4, 3), torch.rand(4, 3, 2))
    chosen = layout.only([2, 0])
    assert chosen.position.equal(layout.position[:, [2, 0]])
    assert chosen.aperture_radius.equal(layout.aperture_radius[:, [2, 0]])
    assert chosen.focus.equal(layout.focus[:, [2, 0]])


def test_to_changes_the_type_of_all_three():
    layout = Layout([[0.0, 0.0]], [1.0], [5.0]).to(torch.float32)
    assert {t.dtype for t in (layout.position, layout.aperture_radius, layout.focus)} == {torch.float32}


def test_count_is_the_number_of_lenses():
    assert Layout(torch.rand(5, 3, 2), torch.rand(5, 3), torch.rand(5, 3)).count == 3


@pytest.mark.parametrize(
    ("position", "aperture_radius", "focus"),
    [
        ([[0.0, 0.0]], [1.0, 1.0], [5.0, 5.0]),
        ([[0.0, 0.0, 0.0]], [1.0], [5.0]),
        ([[0.0, 0.0], [1.0, 1.0]], [1.0, 1.0], [5.0]),
    ],
    ids=["more radii than positions", "three coordinates", "fewer foci than lenses"],
)
def test_different_numbers_of_lenses_are_refused(position, aperture_radius, focus):
    with pytest.raises(ValueError, match="must be"):
        Layout(position, aperture_radius, focus)
