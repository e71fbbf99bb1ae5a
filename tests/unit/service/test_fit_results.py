"""What a fit has found is told in the words of the wire, of one picture as of several."""

import math
from dataclasses import replace

import numpy as np
import pytest

from api_schemas import results as wire
from fitter import request as fitter_request
from fitter import result as fitter_result
from fitter.measurement.definitions import Measurement
from fitter.parameters import BodyParameters, CameraTilt, Light, Reflectance
from fitter.person.fitted_person import FittedPerson
from fitter.person.several_pictures import CombinedShape
from fitter.render.camera import Camera
from fitter.vocabulary.choices import Facing, LightKind, ViewKind
from fitter.vocabulary.outcomes import (
    FacingSource,
    FocalLengthSource,
    LimbFacing,
    StanceKind,
)
from fitter.vocabulary.remarks import Code, Note, Severity, assumed, remark
from service.compute.fit_results import fit_result

PARTS = ("pelvis", "spine")


CIRCLE = remark(Code.CONTRADICTED, "It is a circle.", severity=Severity.BLOCKS)
DARK = remark(Code.TOO_DARK, "Dark.", severity=Severity.HARMS)


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
        limb_facing=(
            LimbFacing(
                limb="left_shin",
                facing=fitter_request.Facing.AWAY,
                source=FacingSource.PRIOR,
                ambiguous=True,
                alternative_nats=1.6,
            ),
        ),
        assumptions=(assumed(Note.LENS_ASSUMED, "Unknown.", where=("focal_length_35mm",)),),
        warnings=(remark(Note.LOW_OVERLAP, "Look."),),
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
        assumptions=(assumed(Note.HEIGHT_ASSUMED, "Unknown.", where=("height_m",)),),
        warnings=(remark(Note.UNUSUAL_HEIGHT, "Look twice."),),
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
    translated = fit_result(result(light=light), part_names=PARTS)
    assert wire.FitResult.model_validate_json(translated.model_dump_json()) == translated


def test_a_result_says_the_same_in_both_languages():
    translated = fit_result(result(light=POINT_LIGHT), part_names=PARTS)
    (view,) = translated.views
    assert list(view.body.pose) == list(PARTS)
    assert view.body.pose[PARTS[1]] == (0.0, -0.5, 0.0)
    assert translated.shape == view.body.shape == (1.0, -2.0)
    assert view.body.translation_m == (0.0, 0.1, 3.0)
    assert view.image_camera.width == 128
    assert view.image_camera.focal_length_px == 1000.0
    assert view.light is not None
    assert view.light.azimuth_deg == pytest.approx(30.0)
    assert view.light.distance_m == 2.0
    assert view.reflectance is not None
    assert view.reflectance.mean_albedo == pytest.approx(0.4)
    assert view.limb_facing[0].facing is Facing.AWAY
    assert translated.outcome_explanation == "The energy stopped decreasing."
    assert translated.stages[0].energies == {"silhouette": 2.5}
    assert translated.agreement is None


def test_what_is_said_of_a_picture_stands_with_it():
    translated = fit_result(result(light=None), part_names=PARTS)
    (view,) = translated.views
    assert [each.where for each in view.assumptions] == [("focal_length_35mm",)]
    assert [each.where for each in translated.assumptions] == [("height_m",)]
    assert [each.code for each in view.warnings] == ["low-silhouette-overlap"]
    assert [each.code for each in translated.warnings] == ["unusual-height"]


@pytest.mark.parametrize("verdict", fitter_result.VERDICT_EXPLANATIONS)
def test_where_a_person_is_contradicted_the_outcome_is_explained_by_it(verdict):
    ended = result(light=None)
    found = replace(ended.found, verdict=verdict, findings=(CIRCLE, DARK))
    translated = fit_result(found_otherwise(ended, found), part_names=PARTS)
    assert translated.verdict == verdict.value
    explained = fitter_result.VERDICT_EXPLANATIONS[verdict]
    assert translated.outcome_explanation == f"{explained} contradicted: {CIRCLE.text}"


def test_a_result_says_which_measurements_were_given():
    given = fit_result(result(light=None), part_names=PARTS)
    assert [each.given for each in given.measurements] == [True]
    assert given.stages[0].measurements == {"weight": given.measurements[0].value}
    free = fit_result(replace(result(light=None), given=()), part_names=PARTS)
    assert [each.given for each in free.measurements] == [False]


def test_a_measurement_has_the_interval_that_holds_95_of_100():
    found = result(light=None)
    (weight,) = found.measurements
    uncertain = replace(found, measurements=(replace(weight, standard_error=2.0),))
    (told,) = fit_result(uncertain, part_names=PARTS).measurements
    assert (told.low, told.high) == (66.08, 73.92)
    (unknown,) = fit_result(found, part_names=PARTS).measurements
    assert (unknown.low, unknown.high) == (None, None)


def test_the_tilt_is_told_with_the_stance():
    tilt = CameraTilt(
        pitch=math.radians(-8.0),
        roll=math.radians(1.5),
        covariance=np.diag([math.radians(2.0) ** 2, math.radians(1.0) ** 2]),
        stances={StanceKind.STANDING: 0.2, StanceKind.STRIDING: 0.7, StanceKind.OTHER: 0.1},
    )
    fitted = result(light=None)
    found = replace(fitted.found, person=replace(fitted.person, tilt=tilt))
    translated = fit_result(found_otherwise(fitted, found), part_names=PARTS)
    (view,) = translated.views
    assert view.tilt is not None
    assert view.tilt.pitch_deg == pytest.approx(-8.0)
    assert view.tilt.pitch_standard_error_deg == pytest.approx(2.0)
    assert view.tilt.roll_deg == pytest.approx(1.5)
    assert view.tilt.roll_standard_error_deg == pytest.approx(1.0)
    assert view.tilt.stance is StanceKind.STRIDING
    assert view.tilt.stances[StanceKind.STANDING] == 0.2
    assert wire.FitResult.model_validate_json(translated.model_dump_json()) == translated


def test_a_directional_light_has_no_distance():
    (view,) = fit_result(result(light=SUN), part_names=PARTS).views
    assert view.light is not None
    assert view.light.distance_m is None


def test_a_pose_of_another_number_of_parts_is_not_passed_over():
    with pytest.raises(ValueError, match="zip"):
        fit_result(result(light=None), part_names=("pelvis",))


def several(*, light: Light | None = POINT_LIGHT) -> fitter_result.FitResult:
    """Two pictures, of which the second contradicts the person."""
    one = result(light=light)
    (front,), (stage,) = one.views, one.stages
    doubtful = replace(
        front.found,
        verdict=fitter_result.Verdict.IMPLAUSIBLE,
        findings=(CIRCLE, DARK),
        silhouette_overlap=0.4,
    )
    views = (
        replace(front, kind=ViewKind.FRONT),
        replace(front, kind=ViewKind.SIDE, found=doubtful),
    )
    alone = CombinedShape(shape=one.shape, agreement=0.4, differing=1)
    return replace(one, views=views, stages=(replace(stage, bodies=2 * stage.bodies),), alone=alone)


def test_of_every_picture_is_said_what_is_said_of_the_only_one():
    translated = fit_result(several(), part_names=PARTS)
    assert wire.FitResult.model_validate_json(translated.model_dump_json()) == translated
    (alone,) = fit_result(result(light=POINT_LIGHT), part_names=PARTS).views
    first, second = translated.views
    assert first == alone.model_copy(update={"view": ViewKind.FRONT})
    assert (second.view, second.silhouette_overlap) == ("side", 0.4)
    assert [each.code for each in second.findings] == ["contradicted", "too-dark"]
    assert translated.agreement == 0.4


def test_the_worst_view_gives_the_verdict_and_its_reason():
    translated = fit_result(several(), part_names=PARTS)
    assert [each.verdict for each in translated.views] == ["plausible", "implausible"]
    assert translated.verdict == "implausible"
    assert "It is a circle." in translated.outcome_explanation
