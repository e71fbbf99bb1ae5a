from dataclasses import asdict

import numpy as np

from fitter.parameters import Light
from fitter.request import KnownMeasurement
from fitter.vocabulary.choices import Clothing, Gender, LightKind
from tests.accuracy.scene import Half, Series
from tests.accuracy.true_picture import Told, TruePicture, told_request
from tests.accuracy.truth import TrueBody
from tests.one_picture import one_picture

MASK = np.zeros((4, 3), dtype=np.bool_)

PICTURE = TruePicture(
    name="picture",
    person="somebody",
    series=Series.FOREIGN,
    half=Half.TUNING,
    request=one_picture(
        image=b"", clicks={}, gender=Gender.MALE, height_m=1.8, focal_length_35mm=50.0
    ),
    body_mask=MASK,
    person_mask=MASK,
    focal_length_px=900.0,
    light=Light(kind=LightKind.POINT, azimuth=0.5, elevation=0.3, distance=2.0),
    joints=np.full((17, 3), np.nan),
    truth=TrueBody(
        canonical=np.zeros((3, 3)),
        triangles=np.array([[0, 1, 2]]),
        measurements={"weight": 81.0, "chest_girth": 100.0},
        stature_m=1.8,
    ),
)


def test_who_is_told_nothing_is_asked_as_the_service_would_be():
    assert asdict(told_request(PICTURE, Told())) == asdict(PICTURE.request)


def test_a_focal_length_in_pixels_takes_the_place_of_another():
    asked = told_request(PICTURE, Told(focal_length=True))
    (view,) = asked.views
    assert (view.focal_length_px, view.focal_length_35mm) == (900.0, None)


def test_proposed_points_take_the_place_of_all_clicks():
    (view,) = told_request(PICTURE, Told(proposed=True)).views
    assert view.complete_clicks
    assert not view.clicks


def test_what_is_given_are_true_measurements():
    asked = told_request(PICTURE, Told(measurements=("weight",)))
    assert asked.person.measurements == {"weight": KnownMeasurement(value=81.0)}


def test_mask_and_clothing_are_told():
    asked = told_request(PICTURE, Told(mask=True, clothing=Clothing.LOOSE))
    (view,) = asked.views
    assert view.mask is not None
    assert view.clothing is Clothing.LOOSE


def test_the_index_of_body_mass_is_of_the_true_body():
    assert PICTURE.truth.bmi == 25.0
