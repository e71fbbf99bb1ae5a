from dataclasses import replace

from fitter.vocabulary.choices import Clothing
from tests.accuracy.foreign import FIRST_REPORTED
from tests.accuracy.scan_tables import scan_lines, worst_scan_lines
from tests.accuracy.scans import Pair, Scanned, Views, own_pairs
from tests.accuracy.scene import Half, Series
from tests.accuracy.table import MEASUREMENTS

KEYS = [key for _, key, _ in MEASUREMENTS]


def _scanned(
    person: str,
    error: float,
    *,
    views: Views = Views.BOTH,
    weight_given: bool = False,
    standard_error: float = 1.0,
) -> Scanned:
    known = [key for key in KEYS if not (weight_given and key == "weight")]
    return Scanned(
        person=person,
        series=Series.PHONE,
        half=Half.TUNING,
        views=views,
        weight_given=weight_given,
        errors=dict.fromkeys(KEYS, error),
        standard_errors=dict.fromkeys(known, standard_error),
        joint_mm=20.0 * abs(error),
        overlap=0.95,
    )


def _line(lines: list[str], beginning: str) -> list[str]:
    (line,) = [line for line in lines if line.startswith(f"{beginning:24s}")]
    return line.removeprefix(beginning).split()


def test_views_sum_up_their_people():
    found = [_scanned("a", 1.0), _scanned("b", -2.0), _scanned("a", 4.0, views=Views.SIDE)]
    lines = scan_lines(found)
    people, error, spread, bias, width, *_, held, joints, overlap = _line(lines, "front + side")
    assert [people, error, spread, bias, width] == ["2", "1.50", "±0.50", "(-0.50)", "3.9"]
    assert [held, joints, overlap] == ["50%", "30.0", "0.950"]
    assert _line(lines, "side")[:3] == ["1", "4.00", "(+4.00)"]
    assert len(lines) == 3


def test_a_weight_that_was_given_has_no_interval_to_hold_it():
    inside = _scanned("a", 1.0, weight_given=True)
    line = _line(scan_lines([inside]), "front + side, weight")
    assert line.count("-") == 1
    assert line[-3] == "100%"


def test_what_was_said_of_clothes_is_told_apart():
    found = [
        _scanned("a", 1.0),
        replace(_scanned("a", 3.0), clothing=Clothing.TIGHT),
    ]
    lines = scan_lines(found)
    assert _line(lines, "front + side")[1] == "1.00"
    assert _line(lines, "front + side, said tight")[1] == "3.00"


def test_the_worst_are_judged_from_front_and_side_without_the_weight():
    found = [
        _scanned("small", 1.0),
        _scanned("large", -5.0),
        _scanned("large", 9.0, views=Views.FRONT),
        _scanned("small", 9.0, weight_given=True),
    ]
    lines = worst_scan_lines(found)
    assert [line.split()[:2] for line in lines[1:]] == [["large", "-5.0"], ["small", "+1.0"]]


def test_a_half_has_its_own_pairs_alone():
    for half in Half:
        pairs = own_pairs(half)
        assert len(pairs) == 12
        assert {pair.half for pair in pairs} == {half}


def test_four_pictures_are_a_pair_and_two_more():
    of = own_pairs(None)[0].pictures_by_views
    assert [len(of[views]) for views in Views] == [1, 1, 2, 4]
    alone = Pair(
        person=FIRST_REPORTED, series=Series.FOREIGN, half=Half.TUNING, front="f", side="s"
    )
    assert Views.FOUR not in alone.pictures_by_views
