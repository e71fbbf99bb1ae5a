"""The whole of section 3.1 on the shipped body models."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from fitter.body.model import regress
from fitter.body.pose_prior import pose_prior
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import shape_for_height
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import InvalidInputError
from fitter.parameters import BodyParameters
from fitter.pose_init.click_problem import ClickedPoints
from fitter.pose_init.initial_pose import InitialPose, initialize_pose
from fitter.pose_init.landmark_rig import landmark_rig
from fitter.render.camera import Camera
from fitter.vocabulary.choices import Facing
from tests.unit.pose_init.scenes import CLICK_SPREADS_M, CLICKED
from tests.unit.pose_init.stick_figure import plausible_pose

CAMERA = Camera(focal_length_px=600.0, centre_x=320.0, centre_y=240.0, width=640, height=480)
LIMB_ENDS = tuple(
    name
    for name in CLICKED
    if name.endswith(("shoulder", "elbow", "wrist", "hip", "knee", "ankle"))
)


@functools.cache
def evaluator(gender: str) -> ScapeEvaluator:
    return ScapeEvaluator(load_body_model(packaged_model_path(gender)))


def clicked(body: BodyParameters, gender: str, *, noise_px: float, seed: int) -> ClickedPoints:
    model = evaluator(gender).model
    landmarks = regress(model.landmarks, evaluator(gender).vertices(body))
    rows = [model.landmarks.names.index(name) for name in CLICKED]
    noise = noise_px * np.random.default_rng(seed).standard_normal((len(rows), 2))
    return ClickedPoints(
        names=tuple(CLICKED),
        pixels=CAMERA.project(landmarks[rows]) + noise,
        spread_m=CLICK_SPREADS_M,
    )


def true_body(gender: str, seed: int, *, spread: float) -> BodyParameters:
    """A person whose shape differs from the mean of the height, in a plausible pose."""
    rng = np.random.default_rng(seed)
    mean = shape_for_height(evaluator(gender), 1.72)
    shape = mean + spread * rng.standard_normal(len(mean)) * (np.arange(len(mean)) > 0)
    rig = landmark_rig(evaluator(gender).model, mean)
    prior = pose_prior(rig.part_names, rig.part_parent, rig.rest_joints)
    pose = plausible_pose(prior, rng, yaw=rng.normal(0.0, 0.6))
    return BodyParameters(pose=pose, translation=np.array([0.1, 0.0, 3.0]), shape=shape)


def found(
    body: BodyParameters, gender: str, clicks: ClickedPoints, **facing: Facing
) -> InitialPose:
    shape = shape_for_height(evaluator(gender), 1.72)
    return initialize_pose(
        evaluator(gender), camera=CAMERA, clicks=clicks, shape=shape, limb_facing=facing
    )


def joint_errors_mm(body: BodyParameters, pose: InitialPose, gender: str) -> np.ndarray:
    model = evaluator(gender).model
    rows = [model.landmarks.names.index(name) for name in LIMB_ENDS]
    hips = [LIMB_ENDS.index(name) for name in ("left_hip", "right_hip")]
    truth, result = (
        regress(model.landmarks, evaluator(gender).vertices(parameters))[rows]
        for parameters in (body, pose.parameters)
    )
    truth, result = (points - points[hips].mean(axis=0) for points in (truth, result))
    return 1e3 * np.linalg.norm(result - truth, axis=1)


@pytest.mark.parametrize("gender", ["female", "male"])
def test_people_unlike_the_mean_are_found_from_noisy_clicks(gender):
    errors = []
    for seed in range(10):
        body = true_body(gender, seed, spread=1.0)
        clicks = clicked(body, gender, noise_px=2.5, seed=seed)
        errors.append(joint_errors_mm(body, found(body, gender, clicks), gender))
    assert np.median(errors) < 65.0


def test_landmarks_of_the_surface_meet_exact_clicks():
    body = true_body("male", 3, spread=0.0)
    pose = found(body, "male", clicked(body, "male", noise_px=0.0, seed=3))
    assert np.median(list(pose.residual_px.values())) < 2.0


def test_hypotheses_are_ranked_and_distinct():
    body = true_body("female", 5, spread=1.0)
    pose = found(body, "female", clicked(body, "female", noise_px=2.5, seed=5))
    energies = [hypothesis.energy for hypothesis in pose.hypotheses]
    assert energies == sorted(energies)
    assert 1 <= len(energies) <= 8
    assert pose.parameters is pose.hypotheses[0].parameters
    for hypothesis in pose.hypotheses[1:]:
        assert np.abs(hypothesis.parameters.pose - pose.parameters.pose).max() > np.radians(5.0)


@pytest.mark.parametrize("word", list(Facing))
def test_the_callers_word_holds_in_every_hypothesis(word):
    body = true_body("female", 6, spread=1.0)
    clicks = clicked(body, "female", noise_px=2.5, seed=6)
    pose = found(body, "female", clicks, left_forearm=word, right_thigh=word)
    for hypothesis in pose.hypotheses:
        assert hypothesis.facing["left_forearm"] is word
        assert hypothesis.facing["right_thigh"] is word


def test_the_shape_given_is_the_shape_returned():
    body = true_body("male", 7, spread=1.0)
    pose = found(body, "male", clicked(body, "male", noise_px=2.5, seed=7))
    np.testing.assert_array_equal(pose.parameters.shape, shape_for_height(evaluator("male"), 1.72))
    assert pose.root_depth_m == pose.parameters.translation[2]
    assert set(pose.residual_px) == set(CLICKED)


def test_a_few_points_still_give_a_body():
    body = true_body("male", 8, spread=1.0)
    clicks = clicked(body, "male", noise_px=2.5, seed=8)
    few = clicks.only(
        ("left_shoulder", "right_shoulder", "left_hip", "left_knee", "right_knee", "left_elbow")
    )
    pose = found(body, "male", few)
    assert np.isfinite(pose.parameters.pose).all()
    assert pose.root_depth_m == pytest.approx(3.0, rel=0.2)


def test_one_side_alone_gives_a_body_seen_from_the_side():
    body = true_body("male", 9, spread=0.0)
    clicks = clicked(body, "male", noise_px=1.0, seed=9)
    left = clicks.only(tuple(name for name in CLICKED if name.startswith("left_")))
    pose = found(body, "male", left)
    assert np.isfinite(pose.parameters.pose).all()
    assert np.median(list(pose.residual_px.values())) < 12.0


def test_a_trunk_without_points_is_refused():
    body = true_body("male", 10, spread=0.0)
    clicks = clicked(body, "male", noise_px=0.0, seed=10).only(("left_knee", "left_ankle", "nose"))
    with pytest.raises(InvalidInputError):
        found(body, "male", clicks)


def test_a_person_is_never_put_behind_the_camera():
    body = true_body("male", 11, spread=0.1)
    clicks = clicked(body, "male", noise_px=0.0, seed=11)
    rng = np.random.default_rng(0)
    found_in_front = refused = 0
    for _ in range(12):
        permuted = replace(clicks, pixels=clicks.pixels[rng.permutation(len(clicks.names))])
        try:
            assert found(body, "male", permuted).root_depth_m > 0.1
            found_in_front += 1
        except InvalidInputError:
            refused += 1
    assert found_in_front
    assert refused
