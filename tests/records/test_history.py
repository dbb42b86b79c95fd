"""What a search went through, and what made a design, to a file and back."""

import json

import pytest
import torch

from multilens.convergence import Convergence
from multilens.records import convergence_record, origin_record, read_convergence, read_origin
from multilens.storage import Origin


def through_json(value):
    """What a file gives back."""
    return json.loads(json.dumps(value, allow_nan=False))


def test_an_origin_comes_back():
    origin = Origin(2**70, 256, 24, "distance_penalty", 0.1, {"torch": "2.13.0+cpu", "python": "3.11.9"}, "abc+")
    assert read_origin(through_json(origin_record(origin)), "origin") == origin
    assert read_origin(through_json(origin_record(Origin(0, 1, 1, "p", None))), "origin") == Origin(0, 1, 1, "p", None)


def test_what_was_known_is_told_where_there_was_any():
    origin = Origin(0, 0, 0, "p", None, known=3)
    assert read_origin(through_json(origin_record(origin)), "origin") == origin
    assert "known" not in origin_record(Origin(0, 1, 1, "p", None))


def test_a_history_is_kept_to_six_digits():
    scores = torch.tensor([[1.23456789e10, torch.nan], [-0.000123456789, torch.inf]], dtype=torch.float64)
    convergence = Convergence((0, 20), scores, (1, 0), (1 / 3, torch.nan))
    record = through_json(convergence_record(convergence))
    assert record["scores"] == [[12345700000.0, None], [-0.000123457, None]]
    again = read_convergence(record, "convergence")
    assert (again.steps, again.polished) == ((0, 20), (1, 0))
    assert again.scores.isnan().tolist() == [[False, True], [False, True]]
    assert again.polished_scores[0] == 1 / 3
    assert again.polished_scores[1] != again.polished_scores[1]


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        ({"scores": [[1.0]]}, "c.scores[0] must be a list of 2, got 1"),
        ({"polished": [3]}, "c.polished must name starts from 0 to 0, got 3"),
        ({"polished_scores": [1.0, 2.0]}, "c.polished_scores must be at most 1, got 2"),
        ({"steps": [0, 1.5]}, "c.steps[1] must be a whole number, got 1.5"),
    ],
)
def test_a_history_that_does_not_fit_together_is_refused(spoil, message):
    fine = {"steps": [0, 20], "polished": [0], "polished_scores": [1.0], "scores": [[2.0, None]]}
    with pytest.raises(ValueError, match="c") as refusal:
        read_convergence(fine | spoil, "c")
    assert str(refusal.value) == message
