import json
import math
from collections.abc import Mapping

import pytest
from pydantic import TypeAdapter, ValidationError

from api_schemas.fit import FitRequest
from api_schemas.points import Points, named_points
from fitter import request as fitter_request
from fitter.detection.landmark_meanings import SPREAD_EXPONENT, spread_m
from fitter.vocabulary.choices import LightKind, PaperEnergy
from fitter.vocabulary.points import POINT_NAMES
from service.compute import translate
from service.jobs.inputs import SentPicture

PARTS = ("pelvis", "spine")

PERSON = {"gender": "female", "height_m": 1.65, "cues": "SE", "optimizer": "simplex"}
VIEW = {
    "focal_length_35mm": 35,
    "clothing": "loose",
    "points": {
        "nose": [10, 20],
        "left_knee": {"x": 30, "y": 40, "visibility": 1},
        "left_ankle": [1, 2, 0],
    },
    "light": {"kind": "directional", "azimuth_deg": 90, "elevation_deg": -45},
    "limb_facing": {"left_forearm": "toward"},
}


NO_PICTURE = (SentPicture(b"", None),)


def asked(said_of_view: Mapping[str, object], **said: object) -> FitRequest:
    words = PERSON | said | {"views": [VIEW | said_of_view]}
    return FitRequest.model_validate_json(json.dumps(words))


def fit_request() -> fitter_request.FitRequest:
    return translate.fit_request(asked({}), (SentPicture(b"image", b"mask"),), max_pixels=7)


def test_a_request_says_the_same_in_both_languages():
    request = fit_request()
    (view,) = request.views
    assert view.image == b"image"
    assert view.mask == b"mask"
    assert view.kind is None
    assert request.choices.max_pixels == 7
    assert request.person.gender is fitter_request.Gender.FEMALE
    assert request.person.height_m == 1.65
    assert view.focal_length_px is None
    assert view.focal_length_35mm == 35.0
    assert view.cues is fitter_request.Cues.SE
    assert request.choices.optimizer is fitter_request.OptimizerKind.SIMPLEX
    assert view.clothing is fitter_request.Clothing.LOOSE
    assert view.limb_facing == {"left_forearm": fitter_request.Facing.TOWARD}


def test_clothing_may_be_said_of_a_region_alone():
    (view,) = translated(clothing={"upper": "loose"}).views
    assert view.clothing == fitter_request.SaidClothing(
        upper=fitter_request.Clothing.LOOSE, lower=fitter_request.Clothing.AUTO
    )
    with pytest.raises(ValidationError):
        translated(clothing={"lower": "outer"})


def test_the_papers_own_method_is_passed_on_where_it_is_asked_for():
    assert fit_request().choices.paper is None
    words = asked({}, paper={"energies": ["edges"], "free_height": True})
    paper = translate.fit_request(words, NO_PICTURE, max_pixels=7).choices.paper
    assert paper == fitter_request.Paper(energies=frozenset({PaperEnergy.EDGES}), free_height=True)


def known(**fields: object) -> dict[str, fitter_request.KnownMeasurement]:
    request = translate.fit_request(asked({}, **fields), NO_PICTURE, max_pixels=7)
    return dict(request.person.measurements)


def test_what_is_known_of_the_person_is_said_by_name_and_place():
    assert known() == {}
    assert known(
        weight_kg=64.5,
        measurements={"hip_girth": 98, "inseam": {"value": 78.5, "standard_error": 1.5}},
    ) == {
        "weight": fitter_request.KnownMeasurement(value=64.5, field="weight_kg"),
        "hip_girth": fitter_request.KnownMeasurement(value=98.0),
        "inseam": fitter_request.KnownMeasurement(value=78.5, standard_error=1.5),
    }


def test_a_guessed_point_is_occluded_and_an_absent_one_is_left_out():
    assert fit_request().views[0].clicks == {
        "nose": fitter_request.Click(x=10.0, y=20.0),
        "left_knee": fitter_request.Click(x=30.0, y=40.0, occluded=True),
    }


def translated(**fields: object) -> fitter_request.FitRequest:
    return translate.fit_request(asked(fields), NO_PICTURE, max_pixels=7)


def clicks_of(**fields: object) -> Mapping[str, fitter_request.Click]:
    return translated(**fields).views[0].clicks


def test_a_proposed_point_has_the_spread_of_proposals_of_its_name():
    def sent(**more: object) -> dict[str, object]:
        return {"x": 1.0, "y": 2.0} | more

    proposal = {"source": "proposal", "confidence": 0.9}
    clicks = clicks_of(
        points={
            "left_hip": sent(**proposal),
            "left_wrist": sent(source="proposal", visibility=1),
            "right_hip": sent(source="click"),
            "neck": sent(source="proposal"),
        }
    )
    assert clicks["left_hip"].spread_m == spread_m("left_hip", 0.9)
    assert clicks["left_wrist"].spread_m == pytest.approx(
        3.0 * spread_m("left_wrist", 1.0), rel=0.01
    )
    assert clicks["left_wrist"].occluded
    # Nothing proposes necks: somebody clicked it.
    assert clicks["right_hip"].spread_m is clicks["neck"].spread_m is None


def test_a_detectors_point_binds_less_the_less_sure_it_is():
    def elbow_spread_m(confidence: float) -> float:
        rows = [[0.5, 0.5, 0.97] for _ in range(17)]
        rows[7][2] = confidence
        points = TypeAdapter(Points).validate_python(rows)
        named = named_points(points)
        found = translate.clicks({"left_elbow": named["left_elbow"]})["left_elbow"].spread_m
        assert found is not None
        return found

    spreads = [elbow_spread_m(confidence) for confidence in (0.99, 0.8, 0.44, 0.1, 0.06)]
    assert spreads == sorted(spreads)
    assert spreads[2] / spreads[0] == pytest.approx((0.99 / 0.44) ** SPREAD_EXPONENT)
    assert elbow_spread_m(0.01) == elbow_spread_m(0.02)


def test_degrees_become_radians():
    light = fit_request().views[0].light
    assert light.kind is LightKind.DIRECTIONAL
    assert light.azimuth == pytest.approx(math.pi / 2)
    assert light.elevation == pytest.approx(-math.pi / 4)
    assert light.distance is None


def test_what_the_caller_leaves_open_stays_open():
    words = FitRequest.model_validate_json('{"gender": "male"}')
    request = translate.fit_request(words, NO_PICTURE, max_pixels=1)
    (view,) = request.views
    assert (view.clicks, view.complete_clicks) == ({}, True)
    assert request.person.height_m is None
    assert view.focal_length_px is None
    assert view.light == fitter_request.LightGuess()
    assert view.limb_facing == {}


def test_every_point_is_a_landmark_of_the_models():
    from service.compute.models import describe

    for model in describe(None).models:
        assert set(POINT_NAMES) <= set(model.landmarks)
        assert 1.5 < model.mean_height_m < 1.9
        assert model.licences
