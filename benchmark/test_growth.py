import pytest

from benchmark.growth import star


@pytest.mark.parametrize("vertices", [20, 2000])
def test_an_outline_has_as_many_vertices_as_were_asked_for(vertices: int) -> None:
    assert len(star(vertices).outline.segments) == vertices
