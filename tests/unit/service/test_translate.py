import json
import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from pydantic import TypeAdapter

from api_schemas import requests as wire_request
from api_schemas import results as wire
from api_schemas.points import Point, Points, PointsFormat, named_points
from api_schemas.requests import FitOptions
from fitter import request as fitter_request
from fitter import result as fitter_result
from fitter.detection.landmark_meanings import SPREAD_EXPONENT, spread_m
from fitter.errors import InvalidInputError
from fitter.fits.progress import Progress, Stage
from fitter.measurement.quantity import Measurement
from fitter.parameters import (
    BodyParameters,
    CameraTilt,
    Light,
    LightKind,
    Reflectance,
    StanceKind,
)
from fitter.person.fitted_person import FittedPerson
from fitter.remarks import Assumption, FitWarning
from fitter.render.camera import Camera, FocalLengthSource
from fitter.vocabulary.points import POINT_NAMES
from service.worker import translate

PARTS = ("pelvis", "spine")

REQUEST = """{
  "gender": "female", "height_m": 1.65, "focal_length_35mm": 35, "cues": "SE",
  "optimizer": "simplex", "clothing": "loose",
  "points": {"nose": [10, 20], "left_knee": {"x": 30, "y": 40, "visibility": 1},
             "left_ankle": [1, 2, 0]},
  "light": {"kind": "directional", "azimuth_deg": 90, "elevation_deg": -45,
            "surroundings": "spherical_harmonics"},
  "limb_facing": {"left_forearm": "toward"}
}"""


def fit_request() -> fitter_request.FitRequest:
    options = FitOptions.model_validate_json(REQUEST)
    return translate.fit_request(options, image=b"image", mask=b"mask", max_pixels=7)


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


def known(**fields: object) -> dict[str, fitter_request.KnownMeasurement]:
    options = FitOptions.model_validate_json(json.dumps(json.loads(REQUEST) | fields))
    request = translate.fit_request(options, image=b"", mask=None, max_pixels=7)
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


def test_a_result_says_which_measurements_were_given():
    given = translate.fit_result(result(light=None), part_names=PARTS)
    assert [each.given for each in given.measurements] == [True]
    assert [each.given for each in given.stages[0].measurements] == [True]
    free = translate.fit_result(replace(result(light=None), given=()), part_names=PARTS)
    assert [each.given for each in free.measurements] == [False]


def test_a_guessed_point_is_occluded_and_an_absent_one_is_left_out():
    assert fit_request().views[0].clicks == {
        "nose": fitter_request.Click(x=10.0, y=20.0),
        "left_knee": fitter_request.Click(x=30.0, y=40.0, occluded=True),
    }


def translated(**fields: object) -> fitter_request.FitRequest:
    options = FitOptions.model_validate_json(json.dumps(json.loads(REQUEST) | fields))
    return translate.fit_request(options, image=b"", mask=None, max_pixels=7)


def clicks_of(**fields: object) -> Mapping[str, fitter_request.Click]:
    return translated(**fields).views[0].clicks


def test_a_proposed_point_has_the_spread_of_proposals_of_its_name():
    def sent(**more: object) -> dict[str, object]:
        return {"x": 1.0, "y": 2.0} | more

    proposal = {"source": "proposal", "confidence": 0.9, "expected_error_px": 7.5}
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


@pytest.mark.parametrize(
    ("layout", "count", "elbow"),
    [("openpose_body25", 25, 6), ("blazepose33", 33, 13), ("coco17", 17, 7)],
)
def test_a_detectors_point_binds_less_the_less_sure_it_is(layout, count, elbow):
    def elbow_spread_m(confidence: float) -> float:
        rows = [[0.5, 0.5, 0.97] for _ in range(count)]
        rows[elbow][2] = confidence
        points = TypeAdapter(Points).validate_python(rows)
        named = named_points(points, PointsFormat(layout), width=1, height=1)
        found = translate.clicks({"left_elbow": named["left_elbow"]})["left_elbow"].spread_m
        assert found is not None
        return found

    spreads = [elbow_spread_m(confidence) for confidence in (0.99, 0.8, 0.44, 0.1, 0.06)]
    assert spreads == sorted(spreads)
    assert spreads[2] / spreads[0] == pytest.approx((0.99 / 0.44) ** SPREAD_EXPONENT)
    assert elbow_spread_m(0.01) == elbow_spread_m(0.02)


def test_what_the_detector_is_to_do_is_said_in_both_languages():
    (usual,) = fit_request().views
    assert not usual.complete_clicks
    assert usual.slant_hints
    assert usual.segmentation is fitter_request.SegmentationKind.SEEDED_GRABCUT
    (other,) = translated(complete_points=True, slant_hints=False, segmentation="grabcut").views
    assert other.complete_clicks
    assert not other.slant_hints
    assert other.segmentation is fitter_request.SegmentationKind.GRABCUT


def test_degrees_become_radians():
    light = fit_request().views[0].light
    assert light.kind is LightKind.DIRECTIONAL
    assert light.azimuth == pytest.approx(math.pi / 2)
    assert light.elevation == pytest.approx(-math.pi / 4)
    assert light.distance is None
    assert light.surroundings is fitter_request.SurroundingsKind.SPHERICAL_HARMONICS


def test_what_the_caller_leaves_open_stays_open():
    options = FitOptions.model_validate_json('{"gender": "male", "points": {"nose": [1, 1]}}')
    request = translate.fit_request(options, image=b"", mask=None, max_pixels=1)
    (view,) = request.views
    assert request.person.height_m is None
    assert view.focal_length_px is None
    assert view.light == fitter_request.LightGuess()
    assert view.limb_facing == {}


def test_every_point_is_a_landmark_of_the_models():
    from service.worker.body_models.described import describe

    for model in describe(None).models:
        assert set(POINT_NAMES) <= set(model.landmarks)
        assert 1.5 < model.mean_height_m < 1.9
        assert model.licences


def test_progress_and_complaints_keep_their_words():
    report = translate.report(
        Progress(stage=Stage.SHADING, fraction=0.5, energies={"silhouette": 2.0})
    )
    assert (report.stage, report.progress, report.energies) == (
        "shading",
        0.5,
        {"silhouette": 2.0},
    )
    error = InvalidInputError(code="a-code", field="mask", reason="Why.", remedy="What.")
    assert translate.field_problem(error).model_dump() == {
        "field": "mask",
        "code": "a-code",
        "reason": "Why.",
        "remedy": "What.",
    }


def result(*, light: Light | None) -> fitter_result.FitResult:
    body = BodyParameters(
        pose=np.array([[0.1, 0.2, 0.3], [0.0, -0.5, 0.0]]),
        translation=np.array([0.0, 0.1, 3.0]),
        shape=np.array([1.0, -2.0]),
    )
    measurement = Measurement(
        name="weight",
        value=70.0,
        unit="kg",
        standard_error=None,
        definition="Volume times density.",
        source="ISO",
    )
    camera = Camera(focal_length_px=500.0, centre_x=32.0, centre_y=24.0, width=64, height=48)
    person = FittedPerson(
        gender=fitter_request.Gender.FEMALE,
        model_checksum="",
        body=body,
        camera=camera.scaled(2.0, width=128, height=96),
        light=light,
        reflectance=None
        if light is None
        else Reflectance(
            albedo=np.array([0.2, 0.4, 0.6]),
            specularity=np.array([0.0, 0.1, 0.2]),
            ambient=0.05,
            specular_exponent=8.0,
        ),
        albedo_rgb=None,
        shape_covariance=None,
    )
    view = fitter_result.FittedView(
        kind=None,
        found=fitter_result.PictureFit(
            person=person,
            height_m=1.65,
            cues=fitter_request.Cues.SES,
            outcome=fitter_result.Outcome.CONVERGED,
            posed_vertices=np.zeros((3, 3)),
            silhouette_overlap=0.93,
        ),
        camera=camera,
        focal_length_source=FocalLengthSource.ASSUMED,
        findings=(),
        limb_facing=(
            fitter_result.LimbFacing(
                limb="left_shin",
                facing=fitter_request.Facing.AWAY,
                source=fitter_result.FacingSource.PRIOR,
                ambiguous=True,
                alternative_energy=1.6,
            ),
        ),
        assumptions=(Assumption(quantity="focal_length_35mm", value=50.0, reason="Unknown."),),
        warnings=(FitWarning(code="a-warning", message="Look."),),
        pictures=fitter_result.Pictures(
            image=np.zeros((48, 64, 3)), trimap=None, segmentation=np.zeros((48, 64), bool)
        ),
    )
    stage = fitter_result.FitStage(
        name="SE",
        bodies=(
            fitter_result.StageBody(
                body=body, posed_vertices=np.zeros((3, 3)), silhouette_overlap=0.9
            ),
        ),
        canonical_vertices=np.zeros((3, 3)),
        energies={"silhouette": 2.5},
        measurements=(measurement,),
    )
    return fitter_result.FitResult(
        views=(view,),
        shape=body.shape,
        shape_covariance=np.eye(2),
        canonical_vertices=np.zeros((3, 3)),
        triangles=np.array([[0, 1, 2]]),
        measurements=(measurement,),
        given=("weight",),
        optimizer=fitter_request.OptimizerKind.GAUSS_NEWTON,
        energies={"silhouette": 1.5},
        evaluations=12,
        stages=(stage,),
        alone=None,
        assumptions=(Assumption(quantity="height_m", value=1.65, reason="Unknown."),),
        warnings=(FitWarning(code="of-the-fit", message="Look twice."),),
        stage_seconds={"shading": 1.0},
    )


def found_otherwise(
    given: fitter_result.FitResult, found: fitter_result.PictureFit
) -> fitter_result.FitResult:
    (view,) = given.views
    return replace(given, views=(replace(view, found=found),))


POINT_LIGHT = Light(kind=LightKind.POINT, azimuth=math.pi / 6, elevation=0.0, distance=2.0)
SUN = Light(kind=LightKind.DIRECTIONAL, azimuth=0.0, elevation=0.0, distance=math.inf)


@pytest.mark.parametrize("light", [None, POINT_LIGHT, SUN], ids=["SE", "point", "directional"])
def test_a_result_survives_the_wire(light):
    translated = translate.fit_result(result(light=light), part_names=PARTS)
    assert wire.FitResult.model_validate_json(translated.model_dump_json()) == translated


def test_a_result_says_the_same_in_both_languages():
    translated = translate.fit_result(result(light=POINT_LIGHT), part_names=PARTS)
    assert [part.part for part in translated.body.pose] == list(PARTS)
    assert translated.body.pose[1].rotation == (0.0, -0.5, 0.0)
    assert translated.body.shape == (1.0, -2.0)
    assert translated.body.translation_m == (0.0, 0.1, 3.0)
    assert translated.image_camera.width == 128
    assert translated.image_camera.focal_length_px == 1000.0
    assert translated.light is not None
    assert translated.light.azimuth_deg == pytest.approx(30.0)
    assert translated.light.distance_m == 2.0
    assert translated.reflectance is not None
    assert translated.reflectance.mean_albedo == pytest.approx(0.4)
    assert translated.outcome_explanation == "The energy stopped decreasing."
    assert translated.stages[0].energies == {"silhouette": 2.5}
    assert translated.limb_facing[0].facing == wire_request.Facing.AWAY
    assert [each.value for each in translated.assumptions] == [50.0, 1.65]
    assert [each.code for each in translated.warnings] == ["a-warning", "of-the-fit"]


@pytest.mark.parametrize("verdict", fitter_result.VERDICT_EXPLANATIONS)
def test_where_a_person_is_contradicted_the_outcome_is_explained_by_it(verdict):
    ended = result(light=None)
    found = replace(ended.found, verdict=verdict, contradictions=("It is a circle.",))
    translated = translate.fit_result(found_otherwise(ended, found), part_names=PARTS)
    assert translated.verdict == verdict.value
    explained = fitter_result.VERDICT_EXPLANATIONS[verdict]
    assert translated.outcome_explanation == f"{explained} It is a circle."


def test_results_of_earlier_versions_have_no_verdict_and_are_read():
    document = json.loads(
        translate.fit_result(result(light=None), part_names=PARTS).model_dump_json()
    )
    del document["verdict"]
    read = wire.FitResult.model_validate_json(json.dumps(document))
    assert read.verdict is wire.Verdict.PLAUSIBLE


def test_who_insists_says_so_in_both_languages():
    assert not fit_request().choices.force
    assert translated(force=True).choices.force


def test_the_tilt_is_told_with_both_cameras_and_the_stance():
    tilt = CameraTilt(
        pitch=math.radians(-8.0),
        roll=math.radians(1.5),
        covariance=np.diag([math.radians(2.0) ** 2, math.radians(1.0) ** 2]),
        stances={StanceKind.STANDING: 0.2, StanceKind.STRIDING: 0.7, StanceKind.OTHER: 0.1},
    )
    fitted = result(light=None)
    found = replace(fitted.found, person=replace(fitted.person, tilt=tilt))
    translated = translate.fit_result(found_otherwise(fitted, found), part_names=PARTS)
    for camera in (translated.camera, translated.image_camera):
        assert camera.pitch_deg == pytest.approx(-8.0)
        assert camera.pitch_standard_error_deg == pytest.approx(2.0)
        assert camera.roll_deg == pytest.approx(1.5)
        assert camera.roll_standard_error_deg == pytest.approx(1.0)
    assert translated.stance is not None
    assert translated.stance.kind is wire.StanceKind.STRIDING
    assert translated.stance.probabilities[wire.StanceKind.STANDING] == 0.2
    assert wire.FitResult.model_validate_json(translated.model_dump_json()) == translated


def test_a_result_of_before_the_tilt_can_be_read():
    old = translate.fit_result(result(light=None), part_names=PARTS).model_dump(mode="json")
    del old["stance"]
    for camera in (old["camera"], old["image_camera"]):
        for field in [name for name in camera if name.startswith(("pitch", "roll"))]:
            del camera[field]
    read = wire.FitResult.model_validate_json(json.dumps(old))
    assert read.stance is None
    assert read.camera.pitch_deg is None


def test_surroundings_are_nine_coefficients_or_null():
    uniform = translate.fit_result(result(light=POINT_LIGHT), part_names=PARTS)
    assert uniform.light is not None
    assert uniform.light.surroundings is None
    surroundings = np.linspace(1.0, -0.2, 9)
    surrounded = replace(POINT_LIGHT, surroundings=surroundings)
    translated = translate.fit_result(result(light=surrounded), part_names=PARTS)
    assert wire.FitResult.model_validate_json(translated.model_dump_json()) == translated
    assert translated.light is not None
    assert translated.light.surroundings is not None
    np.testing.assert_allclose(translated.light.surroundings.coefficients, surroundings)


def test_a_directional_light_has_no_distance():
    translated = translate.fit_result(result(light=SUN), part_names=PARTS)
    assert translated.light is not None
    assert translated.light.distance_m is None


def test_a_pose_of_another_number_of_parts_is_not_passed_over():
    with pytest.raises(ValueError, match="zip"):
        translate.fit_result(result(light=None), part_names=("pelvis",))


def test_points_are_full_form_after_the_checks():
    assert Point(x=1.0, y=2.0).visibility == translate.SEEN
