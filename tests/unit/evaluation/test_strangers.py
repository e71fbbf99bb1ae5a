"""The table of how often strangers in a scan are told."""

from fitter.vocabulary.choices import ViewKind
from tests.evaluation.scene import Half
from tests.evaluation.strangers import Agreement, Pictures, asked_of, stranger_lines


def agreement(share: float, unlike_cm: float, *, same: bool) -> Agreement:
    pictures = Pictures(front="one", other="other", kind=ViewKind.SIDE, same=same)
    return Agreement(pictures=pictures, unlike_cm=unlike_cm, agreement=share)


def test_strangers_are_counted_by_how_unlike_they_are():
    heading, person, near, far = stranger_lines(
        [
            agreement(0.9, 0.0, same=True),
            agreement(0.3, 7.0, same=False),
            agreement(0.04, 25.0, same=False),
            agreement(0.002, 31.0, same=False),
        ]
    )
    assert heading.split()[-1] == "least"
    assert person.split() == ["one", "person", "1", "0", "0", "0", "0", "0", "0.900"]
    assert near.split()[-7:] == ["1", "0", "0", "0", "0", "1", "0.300"]
    assert far.split()[-7:] == ["2", "1", "2", "2", "2", "2", "0.002"]


def test_everybody_is_asked_with_themselves_and_with_others_of_their_gender():
    asked = asked_of(Half.REPORTING)
    strangers = [each for each in asked if not each.same]
    assert len(strangers) == 60
    assert all(each.front[:3] == each.other[:3] for each in strangers)
    assert all(each.front.split("_")[1] in each.other for each in asked if each.same)
