from multilens.back import Back
from multilens.cad.labels import labels
from multilens.cad.plan import Plan, Stand
from multilens.geometry.shape import disc


def test_words_stand_inside_of_what_holds_them_and_else_to_its_right():
    back = Back.rectangle(50, 50).keep_out("logo", disc((20, 20), 10)).keep_out("microphone", disc((40, 9), 0.5))
    lenses = (Stand(1, 10, 40, 1, 8, 5, 2.5, (1.0,)), Stand(2, 30, 40, 2, 2.1, 5, 2.5, (1.0,)))
    first, second, logo, microphone = labels(Plan(back, lenses), height=2.0)
    assert (first.words, first.x, first.y, first.centred) == ("1", 10, 44.5, True)
    assert second.x > 32.1
    assert second.y == 40
    assert not second.centred
    assert (logo.words, logo.x, logo.y, logo.centred) == ("logo", 20, 20, True)
    assert (microphone.words, microphone.centred) == ("microphone", False)
    assert microphone.x > 40.5
