"""What a fault of pictures costs is measured on pictures that have this fault and no other."""

import pytest

from fitter.request import FitRequest
from tests.evaluation.capture_costs import (
    RESTAGED,
    TYPED,
    Cost,
    Kind,
    cost_lines,
    people_of,
)
from tests.evaluation.phone_cases import PHONE_PAIRS
from tests.evaluation.runs import picture_of
from tests.evaluation.scene import Case, Half
from tests.evaluation.table import MEASUREMENTS

PAIR = PHONE_PAIRS["phone_woman_old_heavy"]


def request() -> FitRequest:
    return picture_of(PAIR.front.name).request


def moved(fault: str) -> tuple[bool, bool]:
    """Whether a fault of stance changes how the person stands in front and in side pictures."""

    def change(case: Case) -> bool:
        return RESTAGED[fault](case).stance != case.stance

    return change(PAIR.front), change(PAIR.side)


def cost(fault: str, error: float | None) -> Cost:
    errors = None if error is None else {key: error for _, key, _ in MEASUREMENTS}
    return Cost(kind=Kind.PHONE, fault=fault, person="somebody", errors=errors)


def test_a_fault_of_the_front_is_not_one_of_the_side():
    assert moved("front: arms hanging") == (True, False)
    assert moved("front: turned by 15 degrees") == (True, False)
    assert moved("side: turned by 15 degrees") == (False, True)
    assert moved("side: arms stretched") == (False, True)
    assert moved("camera at 0.5 m") == (False, False)


def test_who_is_turned_in_profile_is_turned_toward_the_camera():
    turned = RESTAGED["side: turned by 15 degrees"](PAIR.side)
    assert abs(turned.stance.facing) == pytest.approx(abs(PAIR.side.stance.facing) - 15.0)


def test_only_what_is_said_to_be_typed_wrongly_is():
    truth = {"weight": 90.0}
    too_tall = TYPED["height 3 cm too high"](request(), truth)
    assert too_tall.person.height_m == pytest.approx((request().person.height_m or 0.0) + 0.03)
    assert too_tall.person.measurements == request().person.measurements
    heavy = TYPED["weight given 3 kg too high"](request(), truth)
    assert heavy.person.measurements["weight"].value == 93.0
    assert heavy.person.height_m == request().person.height_m


def test_refused_scans_are_counted_and_left_out_of_the_means():
    lines = cost_lines([cost("dark", 1.0), cost("dark", -3.0), cost("dark", None)])
    (row,) = [line for line in lines if line.startswith("dark")]
    assert "2.00 (-1.00)" in row
    assert row.split()[-1] == "1"
    assert all("nan" not in line for line in lines)


def test_only_people_of_the_half_are_measured():
    assert len(people_of(Half.TUNING)) == 12
    assert not set(people_of(Half.TUNING)) & set(people_of(Half.REPORTING))
