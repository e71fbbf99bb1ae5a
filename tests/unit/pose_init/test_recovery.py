"""Known poses, projected, clicked and recovered."""

import dataclasses

import numpy as np
import pytest

from fitter.pose_init.click_problem import ClickedPoints
from fitter.pose_init.initial_pose import limb_facings, reference_of
from fitter.pose_init.landmark_rig import landmark_points
from fitter.pose_init.lifting import OrthographicLifting, PerspectiveLifting
from fitter.pose_init.start_poses import start_poses
from fitter.pose_init.trunk import trunk_points
from fitter.vocabulary.choices import Facing
from tests.unit.pose_init.plain_clicks import click_energy, pose_landmarks
from tests.unit.pose_init.scenes import (
    HIPS,
    LENGTHS,
    PRIOR,
    RIG,
    body_points,
    errors_mm,
    scene,
    solve,
)
from tests.unit.pose_init.stick_figure import mirrored_pose

SEEDS = range(24)


def recovered_errors(*, noise_px: float, told: bool, focal_error: float = 1.0) -> np.ndarray:
    errors = []
    for seed in SEEDS:
        truth = scene(seed, noise_px=noise_px)
        camera = dataclasses.replace(
            truth.camera, focal_length_px=focal_error * truth.camera.focal_length_px
        )
        _, fitted = solve(camera, truth.clicks, truth.facing if told else {})
        errors.append(errors_mm(body_points(fitted), truth.points))
    return np.concatenate(errors)


def test_exact_clicks_and_the_callers_word_recover_the_pose():
    errors = recovered_errors(noise_px=0.0, told=True)
    assert np.median(errors) < 25.0
    assert np.percentile(errors, 95) < 130.0


def test_noisy_clicks_and_the_callers_word_recover_the_pose():
    errors = recovered_errors(noise_px=2.5, told=True)
    assert np.median(errors) < 45.0
    assert np.percentile(errors, 95) < 200.0


def test_without_the_callers_word_most_limbs_are_still_right():
    errors = recovered_errors(noise_px=2.5, told=False)
    assert np.median(errors) < 55.0


@pytest.mark.parametrize("focal_error", [0.75, 1.33])
def test_a_wrong_focal_length_bends_the_pose_only_a_little(focal_error):
    errors = recovered_errors(noise_px=2.5, told=True, focal_error=focal_error)
    assert np.median(errors) < 60.0


def closed_form_errors(*, distance: float, focal_length_px: float) -> dict[str, float]:
    """Mean error of both closed forms over the same clicks, the limbs' facing known."""
    errors: dict[str, list[np.ndarray]] = {"perspective": [], "orthographic": []}
    for seed in range(40):
        truth = scene(seed, noise_px=2.5, distance=distance, focal_length_px=focal_length_px)
        trunk = trunk_points(truth.clicks, LENGTHS)
        reference = reference_of(truth.clicks, trunk, LENGTHS)
        for name, lifting in (
            ("perspective", PerspectiveLifting(camera=truth.camera)),
            ("orthographic", OrthographicLifting(camera=truth.camera, scale=reference.scale)),
        ):
            start = start_poses(
                RIG,
                PRIOR,
                lifting,
                {**truth.clicks.by_name(), **trunk.pixels},
                LENGTHS,
                reference.limb,
                limb_facing=truth.facing,
                count=1,
            )
            points = landmark_points(RIG, start.pose[0], start.translation[0])
            errors[name].append(errors_mm(points, truth.points))
    return {name: float(np.mean(values)) for name, values in errors.items()}


def test_near_the_camera_perspective_beats_orthography_as_the_paper_finds():
    errors = closed_form_errors(distance=2.0, focal_length_px=400.0)
    assert errors["perspective"] < 0.8 * errors["orthographic"]


def test_far_from_the_camera_both_projections_agree():
    errors = closed_form_errors(distance=40.0, focal_length_px=8000.0)
    assert errors["perspective"] == pytest.approx(errors["orthographic"], rel=0.08)


def test_the_callers_word_is_obeyed_even_against_the_clicks_evidence():
    truth = scene(3, noise_px=2.5)
    for name in ("left_forearm", "right_thigh", "torso"):
        for word in Facing:
            problem, fitted = solve(truth.camera, truth.clicks, {name: word})
            assert all(facing[name] is word for facing in limb_facings(problem.rig, fitted))


def test_moving_picture_and_principal_point_together_changes_nothing():
    truth = scene(4, noise_px=2.5)
    shift = np.array([37.0, -21.0])
    moved_camera = dataclasses.replace(
        truth.camera, centre_x=truth.camera.centre_x + 37.0, centre_y=truth.camera.centre_y - 21.0
    )
    moved_clicks = dataclasses.replace(truth.clicks, pixels=truth.clicks.pixels + shift)
    _, fitted = solve(truth.camera, truth.clicks, {})
    _, moved = solve(moved_camera, moved_clicks, {})
    np.testing.assert_allclose(moved.pose[0], fitted.pose[0], atol=1e-6)
    np.testing.assert_allclose(moved.translation[0], fitted.translation[0], atol=1e-6)


def test_scaling_picture_and_focal_length_together_changes_nothing():
    truth = scene(4, noise_px=2.5)
    clicks = dataclasses.replace(truth.clicks, pixels=2.0 * truth.clicks.pixels)
    _, fitted = solve(truth.camera, truth.clicks, {})
    _, scaled = solve(truth.camera.scaled(2.0, width=1280, height=960), clicks, {})
    np.testing.assert_allclose(scaled.pose[0], fitted.pose[0], atol=1e-6)


@pytest.mark.parametrize("seed", [5, 6, 7])
def test_the_mirrored_picture_with_sides_exchanged_gives_the_mirrored_pose(seed):
    truth = scene(seed, noise_px=2.5)
    swapped = tuple(
        name.replace("left_", "#").replace("right_", "left_").replace("#", "right_")
        for name in truth.clicks.names
    )
    mirrored_clicks = ClickedPoints(
        names=swapped,
        pixels=truth.clicks.pixels * [-1.0, 1.0] + [2.0 * truth.camera.centre_x, 0.0],
        spread_m=truth.clicks.spread_m,
    )
    _, fitted = solve(truth.camera, truth.clicks, {})
    _, mirrored = solve(truth.camera, mirrored_clicks, {})
    np.testing.assert_allclose(mirrored.energy[0], fitted.energy[0], rtol=1e-3)
    np.testing.assert_allclose(mirrored.pose[0], mirrored_pose(fitted.pose[0]), atol=0.02)


@pytest.mark.parametrize("yaw", [0.0, np.pi])
def test_front_and_back_views_are_told_apart_by_the_order_of_left_and_right(yaw):
    for seed in range(6):
        truth = scene(seed, noise_px=2.5, yaw=yaw)
        _, fitted = solve(truth.camera, truth.clicks, {})
        points = body_points(fitted)
        nose, ear = (RIG.landmark_names.index(name) for name in ("nose", "left_ear"))
        toward_camera = points[nose, 2] < points[ear, 2]
        assert toward_camera == (truth.points[nose, 2] < truth.points[ear, 2])


def test_a_person_upside_down_is_found_upside_down():
    truth = scene(9, noise_px=1.0, yaw=0.3)
    centre = np.array([truth.camera.centre_x, truth.camera.centre_y])
    clicks = dataclasses.replace(truth.clicks, pixels=2.0 * centre - truth.clicks.pixels)
    _, fitted = solve(truth.camera, clicks, truth.facing)
    turned = truth.points * [-1.0, -1.0, 1.0]
    assert np.median(errors_mm(body_points(fitted), turned)) < 60.0


def test_hidden_and_missing_limbs_stay_plausible():
    truth = scene(10, noise_px=2.5)
    kept = tuple(
        name
        for name in truth.clicks.names
        if name not in {"left_wrist", "right_elbow", "right_wrist", "left_ankle", "left_hip"}
    )
    _, fitted = solve(truth.camera, truth.clicks.only(kept), {})
    points = body_points(fitted)
    assert np.isfinite(points).all()
    knee = RIG.landmark_names.index("right_knee")
    relative = points[knee] - points[HIPS].mean(axis=0)
    expected = truth.points[knee] - truth.points[HIPS].mean(axis=0)
    assert np.linalg.norm(relative - expected) < 0.2


def test_upper_body_alone_is_placed():
    truth = scene(11, noise_px=2.5, yaw=0.2)
    kept = tuple(name for name in truth.clicks.names if not name.endswith(("hip", "knee", "ankle")))
    _, fitted = solve(truth.camera, truth.clicks.only(kept), {})
    shoulders = [RIG.landmark_names.index(f"{side}_shoulder") for side in ("left", "right")]
    points = body_points(fitted)
    seen = truth.camera.project(points[shoulders])
    wanted = truth.camera.project(truth.points[shoulders])
    assert np.linalg.norm(seen - wanted, axis=1).max() < 12.0
    assert points[shoulders, 2].mean() == pytest.approx(truth.points[shoulders, 2].mean(), rel=0.12)


def test_refinement_ends_below_the_energy_of_the_truth():
    truth = scene(13, noise_px=2.5)
    problem, fitted = solve(truth.camera, truth.clicks, {})
    assert (np.diff(fitted.energy) >= 0.0).all()
    true_energy = click_energy(
        problem,
        truth.pose[None],
        pose_landmarks(problem.rig, truth.pose[None], truth.translation[None]),
    )[0]
    assert fitted.energy[0] < true_energy
