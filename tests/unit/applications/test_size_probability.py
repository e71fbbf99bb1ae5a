from math import erf, sqrt

import numpy as np
import pytest

from fitter.applications.size_chart import Tolerance, chart_remarks, costs, size_chart
from fitter.applications.size_probability import gaussian_points, size_answer
from fitter.errors import InvalidInputError
from fitter.measurement.joint_measurements import JointMeasurements
from fitter.vocabulary.outcomes import SizedAs

WAISTS = {
    "S": {"waist": (76.0, 80.0)},
    "M": {"waist": (80.0, 84.0)},
    "L": {"waist": (84.0, 88.0)},
}
BOTH = {
    "S": {"chest": (90.0, 94.0), "waist": (76.0, 80.0)},
    "M": {"chest": (94.0, 98.0), "waist": (80.0, 84.0)},
    "L": {"chest": (98.0, 102.0), "waist": (84.0, 88.0)},
}


def normal(x):
    return 0.5 * (1.0 + erf(x / sqrt(2.0)))


def person(values, errors, correlation=0.0):
    errors = np.asarray(errors, dtype=float)
    correlations = np.full((len(errors), len(errors)), correlation)
    np.fill_diagonal(correlations, 1.0)
    return JointMeasurements(
        names=tuple(values),
        units=("cm",) * len(errors),
        values=np.array(list(values.values()), dtype=float),
        covariance=correlations * np.outer(errors, errors),
    )


def answer(chart, someone, *, ease=None, tolerances=None):
    return size_answer(size_chart(chart, tolerances or {}), someone, ease or {})


def chances(found):
    return {each.label: each.probability for each in found.sizes}


def test_of_one_measurement_the_probabilities_are_areas_under_the_normal_curve():
    found = answer(WAISTS, person({"waist": 82.5}, [2.0]))

    def up_to(bound):
        return normal((bound - 82.5) / 2.0)

    # Steps are 4 cm: S reaches 4 cm below its range, L 2 cm above.
    assert chances(found) == pytest.approx(
        {
            "S": up_to(80.0) - up_to(72.0),
            "M": up_to(84.0) - up_to(80.0),
            "L": up_to(90) - up_to(84),
        },
        abs=2e-4,
    )
    assert found.none_fits == pytest.approx(up_to(72.0) + 1.0 - up_to(90.0), abs=2e-4)
    assert found.recommended == "M"
    (waist,) = found.measurements
    assert waist.within == pytest.approx(up_to(84.0) - up_to(80.0))
    assert waist.too_small == pytest.approx(1.0 - up_to(84.0))
    assert waist.sizes == ("M", "L")
    assert "between M and L" in waist.says


def test_of_independent_measurements_where_one_size_fits_the_probabilities_multiply():
    chart = {"only": {"chest": (94.0, 98.0), "waist": (80.0, 84.0)}}
    tight = {name: Tolerance(too_small=1e-6, too_large=1e-6) for name in ("chest", "waist")}
    found = answer(chart, person({"chest": 97.0, "waist": 81.0}, [2.0, 3.0]), tolerances=tight)
    chest = normal(0.5) - normal(-1.5)
    waist = normal(1.0) - normal(-1.0 / 3.0)
    assert found.sizes[0].probability == pytest.approx(chest * waist, abs=2e-3)


def test_correlated_measurements_agree_on_a_size_more_often_than_independent_ones():
    someone = {"chest": 96.0, "waist": 82.0}
    alone = answer(BOTH, person(someone, [2.0, 2.0]))
    together = answer(BOTH, person(someone, [2.0, 2.0], correlation=1.0))
    assert together.sizes[1].probability == pytest.approx(normal(1.0) - normal(-1.0), abs=2e-4)
    assert alone.sizes[1].probability != pytest.approx(together.sizes[1].probability, abs=0.02)


def test_the_probabilities_of_all_sizes_and_of_none_sum_to_one():
    found = answer(BOTH, person({"chest": 91.0, "waist": 87.0}, [3.0, 3.0], correlation=0.6))
    assert sum(chances(found).values()) + found.none_fits == pytest.approx(1.0)


def test_a_body_known_exactly_takes_one_size():
    found = answer(BOTH, person({"chest": 97.9, "waist": 80.1}, [0.0, 0.0]))
    assert chances(found) == {"S": 0.0, "M": 1.0, "L": 0.0}
    assert [each.sized_as for each in found.measurements] == [SizedAs.WITHIN] * 2
    assert found.measurements[1].sizes == ("M",)


def test_between_two_sizes_the_larger_one_is_taken_as_too_small_counts_twice():
    # 1.5 cm above M and 2.5 below L: M costs 1.5 / 2, L 2.5 / 4.
    someone = person({"chest": 95.5, "waist": 85.5}, [0.0, 0.0])
    found = answer(BOTH, someone)
    assert {each.label: each.cost for each in found.sizes} == pytest.approx(
        {"S": 1.5 / 2 + 5.5 / 2, "M": 1.5 / 2, "L": 2.5 / 4}
    )
    assert found.recommended == "L"
    chest, waist = found.measurements
    assert (chest.sized_as, chest.off, chest.low, chest.high) == (
        SizedAs.TOO_LARGE,
        2.5,
        98.0,
        102.0,
    )
    assert waist.sized_as is SizedAs.WITHIN
    even = {"waist": Tolerance(too_small=4.0, too_large=4.0)}
    assert answer(BOTH, someone, tolerances=even).recommended == "M"


def test_a_body_beyond_the_chart_takes_no_size_and_the_nearest_is_spoken_of():
    found = answer(BOTH, person({"chest": 110.0, "waist": 96.0}, [1.0, 1.0]))
    assert found.recommended is None
    assert found.none_fits == pytest.approx(1.0, abs=1e-3)
    assert found.compared_with == "L"
    assert [each.sized_as for each in found.measurements] == [SizedAs.TOO_SMALL] * 2


def test_ease_is_added_to_the_body():
    someone = person({"waist": 82.0}, [1.0])
    assert answer(WAISTS, someone).recommended == "M"
    assert answer(WAISTS, someone, ease={"waist": 4.0}).recommended == "L"
    assert answer(WAISTS, someone, ease={"waist": -4.0}).recommended == "S"
    larger = person({"waist": 86.0}, [1.0])
    eased = answer(WAISTS, someone, ease={"waist": 4.0})
    assert chances(eased) == pytest.approx(chances(answer(WAISTS, larger)))
    assert eased.measurements[0].value == 82.0
    assert eased.measurements[0].ease == 4.0
    assert "86.0 ± 1.0 cm with 4 cm of ease" in eased.measurements[0].says


def test_targets_stand_for_ranges_that_reach_half_way_to_the_next():
    targets = {"S": {"waist": 78.0}, "M": {"waist": 82.0}, "L": {"waist": 88.0}}
    chart = size_chart(targets, {})
    np.testing.assert_allclose(chart.low[:, 0], [76.0, 80.0, 85.0])
    np.testing.assert_allclose(chart.high[:, 0], [80.0, 85.0, 91.0])
    assert chart.too_large[0] == 5.0
    assert chart.too_small[0] == 2.5


def test_what_a_size_says_nothing_of_costs_nothing():
    chart = {
        "M": {"waist": (80.0, 84.0)},
        "M long": {"waist": (80.0, 84.0), "inseam": (82.0, 86.0)},
    }
    built = size_chart(chart, {})
    cost = costs(built, np.array([82.0, 70.0]))
    np.testing.assert_allclose(cost, [[0.0, 0.0], [0.0, 3.0]])
    found = answer(chart, person({"waist": 82.0, "inseam": 70.0}, [0.1, 0.1]))
    assert found.recommended == "M"
    assert found.measurements[1].sized_as is SizedAs.UNSAID
    assert found.measurements[1].sizes == ("M long",)


def test_of_ranges_that_overlap_the_nearer_middle_is_taken():
    chart = {"S": {"waist": (76.0, 82.0)}, "M": {"waist": (80.0, 86.0)}}
    assert answer(chart, person({"waist": 80.9}, [0.0])).recommended == "S"
    assert answer(chart, person({"waist": 81.1}, [0.0])).recommended == "M"


def test_gaps_and_overlaps_are_said():
    chart = {
        "S": {"waist": (76.0, 79.0), "chest": (88.0, 92.0)},
        "M": {"waist": (80.0, 83.0), "chest": (91.0, 95.0)},
        "M long": {"waist": (80.0, 83.0), "chest": (91.0, 95.0)},
    }
    said = chart_remarks(size_chart(chart, {}), ["cm", "cm"])
    remarks = {each.code: each.message for each in said}
    assert set(remarks) == {"chart-gap", "chart-overlap"}
    assert "waist from 79 to 80 cm between S and M" in remarks["chart-gap"]
    assert "chest from 91 to 92 cm of S and M" in remarks["chart-overlap"]
    assert chart_remarks(size_chart(WAISTS, {}), ["cm"]) == ()


def test_a_target_that_all_sizes_share_needs_a_tolerance():
    chart = {"S": {"head": 57.0}, "M": {"head": 57.0}}
    with pytest.raises(InvalidInputError) as caught:
        size_chart(chart, {})
    assert (caught.value.code, caught.value.field) == ("tolerance-needed", "tolerances.head")
    told = {"head": Tolerance(too_small=1.0, too_large=2.0)}
    np.testing.assert_allclose(size_chart(chart, told).low[:, 0], 57.0)


def test_the_same_chart_and_person_give_the_same_numbers():
    someone = person({"chest": 95.0, "waist": 84.0}, [2.0, 2.5], correlation=0.5)
    assert answer(BOTH, someone) == answer(BOTH, someone)


def test_points_have_the_mean_and_covariance_they_stand_for():
    factor = np.array([[2.0, 0.0, 0.0], [1.0, 0.5, 0.0], [0.3, -0.2, 1.5]])
    covariance = factor @ factor.T
    points = gaussian_points(np.array([1.0, -2.0, 3.0]), covariance, power=12)
    np.testing.assert_allclose(points.mean(axis=0), [1.0, -2.0, 3.0], atol=2e-3)
    np.testing.assert_allclose(np.cov(points.T), covariance, atol=0.02)


def test_what_does_not_vary_is_the_same_in_all_points():
    covariance = np.array([[4.0, 0.0], [0.0, 0.0]])
    points = gaussian_points(np.array([1.0, 7.0]), covariance, power=4)
    assert set(points[:, 1]) == {7.0}
    assert len(set(points[:, 0])) == 16


def test_sizes_of_one_range_are_alternatives_and_no_two_to_be_between():
    chart = {
        "M": {"waist": (80.0, 84.0)},
        "M long": {"waist": (80.0, 84.0)},
        "L": {"waist": (84.0, 88.0)},
    }
    (inside,) = answer(chart, person({"waist": 82.0}, [0.5])).measurements
    assert inside.says.endswith("asks for M or M long.")
    (near,) = answer(chart, person({"waist": 83.8}, [0.5])).measurements
    assert near.says.endswith("between M or M long and L.")


def test_a_body_at_the_very_end_of_a_range_lies_in_it():
    (waist,) = answer(WAISTS, person({"waist": 84.0004}, [0.0])).measurements
    assert (waist.sized_as, waist.within, waist.too_small) == (SizedAs.WITHIN, 1.0, 0.0)
