"""A fit of one to six pictures of a person: one shape, and a body in every picture."""

import numpy as np
import pytest

from fitter.errors import InvalidInputError
from fitter.fits.fit import FitRequest, fit
from fitter.request import Cues, Person, View, ViewKind
from tests.benchmarks.requests import resized
from tests.evaluation.cases import CASES
from tests.evaluation.files import read_case
from tests.evaluation.suite import fit_request

STANDING, TURNED = "woman_young_heavy_standing", "woman_young_heavy_turned"


def asked(*names: str, kind: ViewKind | None = None) -> FitRequest:
    pictures = [
        resized(fit_request(read_case(CASES[name]), Cues.SE), width=300, height=400)
        for name in names
    ]
    return FitRequest(
        person=Person(gender=pictures[0].gender, height_m=pictures[0].height_m),
        views=tuple(
            View(image=each.image, clicks=each.clicks, cues=each.cues, kind=kind)
            for each in pictures
        ),
    )


@pytest.mark.parametrize("names", [(STANDING,), (STANDING, TURNED)])
def test_every_picture_shows_the_one_shape(names):
    result = fit(asked(*names))
    assert len(result.views) == len(names)
    for view in result.views:
        np.testing.assert_array_equal(view.found.person.body.shape, result.shape)
        assert view.found.silhouette_overlap > 0.9
    assert {each.name: each.value for each in result.measurements}["stature"] == pytest.approx(
        100.0 * result.found.height_m, abs=0.1
    )


def test_a_fault_of_one_of_several_pictures_is_named_by_its_place():
    request = asked(STANDING, TURNED)
    broken = FitRequest(
        person=request.person,
        views=(request.views[0], View(image=b"", clicks=request.views[1].clicks)),
    )
    with pytest.raises(InvalidInputError) as caught:
        fit(broken)
    assert caught.value.field == "views.1.image"


def test_a_fault_of_the_only_picture_has_no_place():
    with pytest.raises(InvalidInputError) as caught:
        fit(FitRequest(person=asked(STANDING).person, views=(View(image=b"", clicks={}),)))
    assert caught.value.field == "image"
