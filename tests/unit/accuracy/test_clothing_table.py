from collections.abc import Mapping

import pytest

from fitter.vocabulary.choices import Cues
from tests.accuracy.clothing_table import case_lines, clothing_lines, null_lines, underwear_lines
from tests.accuracy.dressed_scores import NOTHING_SAID, SAID, DressedScore
from tests.accuracy.scoring import Scored
from tests.accuracy.seen_labels import CLASSES
from tests.accuracy.table import MEASUREMENTS
from tests.unit.accuracy.test_table import scored_picture

KEYS = [key for _, key, _ in MEASUREMENTS]
SHIRT, CLOSE = "shirt hanging out, trousers", "close-fitting T-shirt, leggings"


def _dressed(
    person: str,
    error: float,
    *,
    said: str = NOTHING_SAID,
    outfit: str = SHIRT,
    overlaps: Mapping[str, float | None] | None = None,
) -> DressedScore:
    return DressedScore(
        said=said, outfit=outfit, scored=_scored(person, error), overlaps=overlaps or {}
    )


def _scored(person: str, error: float) -> Scored:
    return scored_picture(Cues.SES, error, person=person)


def _cells(lines: list[str], beginning: str) -> list[str]:
    (line,) = [line for line in lines if line.startswith(f"{beginning:39s}")]
    return line[39:].split()


def test_errors_and_bias_come_with_their_standard_errors_over_people():
    lines = clothing_lines([_dressed("a", 1.0), _dressed("b", -3.0)])
    people, mean, mean_error, bias, bias_error, *_ = _cells(lines, NOTHING_SAID)
    assert (people, mean, mean_error, bias, bias_error) == ("2", "2.0", "±1.0", "(-1.0", "±2.0)")


def test_a_standard_error_of_two_holds_errors_below_four():
    lines = clothing_lines([_dressed("a", 3.0), _dressed("b", -5.0)])
    assert _cells(lines, NOTHING_SAID)[-3:] == ["50", "±50", "%"]
    widths = lines[lines.index(next(line for line in lines if line.startswith("auto  "))) + 1]
    assert widths.split() == ["median", "width", *["7.8"] * len(KEYS)]


def test_garments_are_summed_up_apart_where_nothing_is_said():
    scores = [
        _dressed("a", 1.0),
        _dressed("b", 4.0, outfit=CLOSE),
        _dressed("b", 9.0, outfit=CLOSE, said="tight"),
    ]
    lines = clothing_lines(scores)
    assert _cells(lines, SHIRT)[:3] == ["1", "1.0", "(+1.0)"]
    assert _cells(lines, CLOSE)[:3] == ["1", "4.0", "(+4.0)"]
    assert _cells(lines, "tight")[:2] == ["1", "9.0"]


def test_overlaps_are_means_over_the_pictures_that_show_a_class():
    shod = dict.fromkeys(CLASSES, 0.9)
    barefoot = {**dict.fromkeys(CLASSES, 0.7), "shoes": None}
    lines = clothing_lines(
        [_dressed("a", 1.0, overlaps=shod), _dressed("b", 1.0, overlaps=barefoot)]
    )
    assert _cells(lines, "skin") == ["2", "0.80", "±0.10", "least", "0.70"]
    assert _cells(lines, "shoes") == ["1", "0.90", "least", "0.90"]


def test_close_fitting_clothes_stand_beside_the_same_people_in_underwear():
    dressed = [_dressed("a", 6.0), _dressed("b", 3.0, outfit=CLOSE)]
    lines = underwear_lines(dressed, [_scored("a", 1.0), _scored("b", 2.0)])
    assert _cells(lines, "the same people in underwear")[:2] == ["2", "1.5"]
    assert _cells(lines, "those in close-fitting clothes")[:2] == ["1", "3.0"]
    assert _cells(lines, "they in underwear")[:2] == ["1", "2.0"]


def test_every_row_is_named_by_what_was_said():
    lines = clothing_lines([_dressed("a", 1.0, said=said) for said in SAID])
    for said in SAID:
        assert _cells(lines, said)[0] == "1"


def test_a_picture_has_a_line_for_all_that_is_said_with_its_garments():
    (line,) = case_lines([_dressed("a", -1.0)])
    assert line.count("-1.0 (2.0)") == len(KEYS)
    assert line.endswith(SHIRT)


@pytest.mark.parametrize(("errors", "cell"), [((2.0, -2.0), "2.0 ±0.0 (+0.0 ±2.0)")])
def test_what_is_said_without_a_picture_has_the_same_columns(errors: tuple[float, ...], cell: str):
    (line,) = null_lines({"null: height": [dict.fromkeys(KEYS, error) for error in errors]})
    assert line.count(cell) == len(KEYS)


def test_what_is_known_has_no_error():
    (line,) = null_lines({"null: height and weight": [{**dict.fromkeys(KEYS, 1.0), "weight": 0.0}]})
    assert line.split()[-3:] == ["-", "1.0", "(+1.0)"]
