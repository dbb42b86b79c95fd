"""Hydra's words for many values, each with what it stands for."""

import pytest

from multilens.app.refusal import RefusedError
from multilens.app.space import read_space
from multilens.sweeps.space import Choice, Span

WIDTH, COUNT = "back.outline.width", "lenses.count"


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        (f"{WIDTH}=interval(20,45)", Span(WIDTH, 20, 45)),
        (f"{WIDTH}=tag(log,interval(1,45))", Span(WIDTH, 1, 45, log=True)),
        (f"{COUNT}=int(interval(2,5))", Span(COUNT, 2, 5, whole=True)),
        (f"{COUNT}=range(2,7)", Span(COUNT, 2, 6, step=1, whole=True)),
        (f"{COUNT}=range(2,7,2)", Span(COUNT, 2, 6, step=2, whole=True)),
        (f"{COUNT}=range(6,1,-2)", Span(COUNT, 2, 6, step=2, whole=True)),
        (f"{COUNT}=tag(log,range(1,9))", Span(COUNT, 1, 8, step=1, whole=True, log=True)),
        (f"{WIDTH}=range(20,21,0.25)", Span(WIDTH, 20, 20.75, step=0.25)),
        (f"{COUNT}=2,5", Choice(COUNT, ("2", "5"))),
        ("depth=choice(room,portrait)", Choice("depth", ("room", "portrait"))),
        ("cues=glob(stereo*)", Choice("cues", ("stereo", "stereo_and_defocus"))),
        ("depth.histogram.edges=[1,2],[3,4]", Choice("depth.histogram.edges", ("[1,2]", "[3,4]"))),
    ],
)
def test_a_word_for_many_values_is_understood(word: str, meant: Span | Choice):
    assert read_space([word]).space == (meant,)


def test_words_are_sorted():
    asked = read_space(["experiment=phone_back_island", f"{WIDTH}=interval(20,45)", "search=quick"])
    assert asked.fixed == ("experiment", "search")
    assert asked.lines == ("experiment=phone_back_island", "search=quick")
    assert asked.written == {WIDTH: "interval(20,45)"}


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([f"{WIDTH}=interval(45,20)"], "from a number to a larger one, got 45 to 20"),
        ([f"{WIDTH}=interval(1,inf)"], "high must be finite"),
        ([f"{WIDTH}=tag(log,interval(0,5))"], "log must begin at a number > 0"),
        ([f"{WIDTH}=tag(wide,interval(1,5))"], "log is the one tag, of an interval or a range, got wide"),
        ([f"{COUNT}=tag(log,choice(1,2))"], "log is the one tag"),
        ([f"{COUNT}=range(2,3)"], "must be two or more numbers, got 2"),
        ([f"{COUNT}=2,2"], "each once"),
        ([f"{COUNT}=1,2", f"{COUNT}=3"], f"{COUNT} must be given once"),
        (["lenses.cout=1,2"], "did you mean lenses.count?"),
        (["depth=room,por"], "did you mean portrait?"),
    ],
)
def test_a_space_that_cannot_be_explored_is_refused_in_one_line(words: list[str], told: str):
    with pytest.raises(RefusedError) as refusal:
        read_space(words)
    assert told in str(refusal.value)
    assert "\n" not in str(refusal.value)
