"""Figures of a validation, on pairs whose figures are known."""

import numpy as np
import pytest

from fitter.population.validation import Pair, error_figures, mean_absolute


def pair(person: str, error: float, **changes: float | None) -> Pair:
    given = {"found": 90.0 + error, "standard_error": 2.0, "tape": 90.0} | changes
    return Pair(person=person, **given)


def test_several_pictures_of_a_person_count_as_one_person():
    figures = error_figures([pair("a", 1.0), pair("a", 1.0), pair("a", 1.0), pair("b", -5.0)])
    assert (figures.people, figures.pictures) == (2, 4)
    assert figures.bias.value == pytest.approx(-2.0)
    assert figures.mean_absolute.value == pytest.approx(3.0)


def test_an_interval_holds_what_lies_within_1_96_standard_errors():
    figures = error_figures([pair("a", 3.9), pair("b", -3.9), pair("c", 4.0), pair("d", 0.0)])
    assert figures.held is not None
    assert figures.held.value == pytest.approx(0.75)
    assert figures.half_width == pytest.approx(3.92, abs=0.01)


def test_without_standard_errors_there_is_no_coverage():
    figures = error_figures(
        [pair("a", 1.0, standard_error=None), pair("b", 2.0, standard_error=None)]
    )
    assert figures.held is None
    assert figures.half_width is None


def test_repeatability_is_pooled_over_people():
    errors = {"a": (1.0, 3.0), "b": (-1.0, -1.0), "c": (7.0,)}
    pairs = [pair(person, error) for person, each in errors.items() for error in each]
    assert error_figures(pairs).repeatability == pytest.approx(np.sqrt(2.0 / 2.0))
    assert error_figures([pair("a", 1.0), pair("b", 2.0)]).repeatability is None


def test_the_truth_is_the_mean_of_two_readings_and_their_difference_the_tape_s_error():
    figures = error_figures([pair("a", 0.0, again=92.0), pair("b", 1.0, again=90.0)])
    assert figures.bias.value == pytest.approx(0.0)
    assert figures.tape_error == pytest.approx(1.0)


def test_readings_count_once_for_a_person_with_several_pictures():
    once = [pair("a", 0.0, again=92.0), pair("b", 1.0, again=90.0)]
    assert error_figures([*once, once[0]]).tape_error == pytest.approx(1.0)


def test_intervals_cover_the_mean_about_as_often_as_they_say():
    rng = np.random.default_rng(7)
    covered = 0
    for _ in range(60):
        errors = rng.normal(1.0, 3.0, 30)
        bias = error_figures([pair(str(n), error) for n, error in enumerate(errors)]).bias
        assert bias.low is not None
        assert bias.high is not None
        covered += bias.low <= 1.0 <= bias.high
    assert 50 <= covered < 60


def test_one_person_has_no_interval():
    bias = error_figures([pair("a", 1.0)]).bias
    assert (bias.value, bias.low, bias.high) == (pytest.approx(1.0), None, None)


def test_the_error_without_a_picture_is_over_people_too():
    assert mean_absolute([[1.0, -1.0, 1.0], [-3.0]]).value == pytest.approx(2.0)
