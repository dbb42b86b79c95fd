"""A bound as plain data and back."""

from typing import Any

from multilens.bounds.bound import Bound
from multilens.fields import number, record, text, whole_number


def bound_record(bound: Bound) -> dict[str, Any]:
    """Give what was proved, or why nothing is known."""
    return {"value": bound.value, "reason": bound.reason, "root": bound.root, "boxes": bound.boxes}


def read_bound(value: object, name: str) -> Bound:
    """Read what `bound_record` gives. The number is not proved anew: `lower_bound` does that, and takes a second or two."""
    fields = record(value, name, ("value", "reason", "root", "boxes"))
    proved, root = (None if fields[key] is None else number(fields[key], f"{name}.{key}") for key in ("value", "root"))
    reason = text(fields["reason"], f"{name}.reason")
    return Bound(proved, reason, root, whole_number(fields["boxes"], f"{name}.boxes"))
