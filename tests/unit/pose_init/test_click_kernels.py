"""The compiled fit to clicks against the plain one and against finite differences."""

import dataclasses

import numpy as np
import pytest

from fitter.detection.detector import DetectedSlants, LimbSlant
from fitter.numerics.rotations import compose, rotation_matrices
from fitter.pose_init import _click_kernels as kernels
from fitter.pose_init.click_fit import fit_clicks, kernel_arguments
from fitter.pose_init.click_problem import ClickProblem, click_problem
from fitter.pose_init.landmark_rig import LandmarkRig, pose_landmarks
from fitter.request import Facing
from tests.unit.pose_init.plain_clicks import click_energy, landmark_jacobian, normal_equations
from tests.unit.pose_init.scenes import PRIOR, RIG, scene

SLANTS = DetectedSlants(
    limbs={
        "left_thigh": LimbSlant(sine=0.2, sigma=0.1),
        "right_upper_arm": LimbSlant(sine=-0.9, sigma=0.05),
    },
    middle=np.array([280.0, 260.0]),
)
FACING = {"left_forearm": Facing.TOWARD, "right_shin": Facing.AWAY, "torso": Facing.TOWARD}


def blended_rig() -> LandmarkRig:
    """The stick figure with landmarks that follow two parts at once."""
    rng = np.random.default_rng(5)
    weights = RIG.weights * 0.7
    for row, part in enumerate(np.argmax(RIG.weights, axis=1)):
        weights[row, max(RIG.part_parent[part], 0)] += 0.3
    arms = weights[..., None] * (RIG.rest_landmarks[:, None] - RIG.rest_joints)
    arms += 0.01 * (weights > 0)[..., None] * rng.standard_normal(arms.shape)
    return dataclasses.replace(RIG, weights=weights, arms=arms)


def blended_problem() -> ClickProblem:
    truth = scene(12, noise_px=2.5)
    return click_problem(
        blended_rig(),
        PRIOR,
        truth.camera,
        truth.clicks,
        scale=200.0,
        limb_facing=FACING,
        slants=SLANTS,
    )


def some_poses(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Poses partly beyond their limits, near the camera's axis."""
    rng = np.random.default_rng(12)
    truth = scene(12, noise_px=2.5)
    poses = truth.pose + 0.4 * rng.standard_normal((count, 17, 3))
    places = truth.translation + 0.05 * rng.standard_normal((count, 3))
    return poses, places


def linearised(
    problem: ClickProblem, pose: np.ndarray, place: np.ndarray
) -> tuple[float, np.ndarray, np.ndarray]:
    rig, prior, clicks, soft, turning = kernel_arguments(problem, problem.pixels)
    k, n = len(problem.rig.landmark_names), 3 * len(turning) + 3
    rotations, joints = np.empty((17, 3, 3)), np.empty((17, 3))
    shares, points = np.empty((k, 17, 3)), np.empty((k, 3))
    matrix, gradient = np.empty((n, n)), np.empty(n)
    kernels.pose_points(rig, pose, place, rotations, joints, shares, points)
    energy = kernels.residuals_energy(rig, prior, clicks, soft, pose, rotations, points)
    kernels.linearise(
        rig, prior, clicks, soft, turning, pose, rotations, joints, shares, points,
        matrix, gradient,
    )  # fmt: skip
    return energy, matrix, gradient


def test_energy_and_normal_equations_agree_with_the_plain_ones():
    problem = blended_problem()
    poses, places = some_poses(4)
    posed = pose_landmarks(problem.rig, poses, places)
    energies = click_energy(problem, poses, posed)
    matrices, gradients = normal_equations(problem, poses, posed)
    for row in range(4):
        energy, matrix, gradient = linearised(problem, poses[row], places[row])
        assert energy == pytest.approx(energies[row], rel=1e-12)
        np.testing.assert_allclose(gradient, gradients[row], rtol=1e-9, atol=1e-7)
        np.testing.assert_allclose(np.tril(matrix), np.tril(matrices[row]), rtol=1e-9, atol=1e-7)


def test_gradient_agrees_with_finite_differences_of_the_energy():
    problem = blended_problem()
    poses, places = some_poses(1)
    _, _, gradient = linearised(problem, poses[0], places[0])
    joints = np.flatnonzero(problem.turning)
    step = 1e-6
    for column in range(len(gradient)):
        moved = []
        for sign in (step, -step):
            turned, shifted = np.zeros((17, 3)), np.zeros(3)
            if column < 3 * len(joints):
                turned[joints[column // 3], column % 3] = sign
            else:
                shifted[column - 3 * len(joints)] = sign
            moved.append(linearised(problem, compose(turned, poses[0]), places[0] + shifted)[0])
        slope = (moved[0] - moved[1]) / (2 * step)
        assert gradient[column] == pytest.approx(slope, rel=1e-4, abs=2e-2)


def test_plain_jacobian_agrees_with_finite_differences():
    rig = blended_rig()
    poses, places = some_poses(2)
    turning = np.random.default_rng(7).random(17) < 0.7
    turning[0] = True
    jacobian = landmark_jacobian(rig, pose_landmarks(rig, poses, places), turning)
    step = 1e-6
    for column, joint in enumerate(np.flatnonzero(turning)):
        for axis in range(3):
            ahead = np.zeros((34, 3))
            ahead[[joint, 17 + joint], axis] = step
            moved = [
                pose_landmarks(
                    rig, compose(sign * ahead, poses.reshape(-1, 3)).reshape(2, 17, 3), places
                ).points
                for sign in (1.0, -1.0)
            ]
            slope = (moved[0] - moved[1]) / (2 * step)
            np.testing.assert_allclose(jacobian[..., 3 * column + axis], slope, atol=1e-8)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.3, 3.0, np.pi])
def test_rotations_agree_with_the_project_s_own(angle):
    rng = np.random.default_rng(3)
    first, second = rng.standard_normal((2, 3))
    first *= angle / np.linalg.norm(first)
    matrix = np.empty((3, 3))
    kernels.rotation_matrix(first, matrix)
    np.testing.assert_allclose(matrix, rotation_matrices(first[None])[0], atol=1e-12)
    turned = second.copy()
    kernels.turn_further(first, turned)
    np.testing.assert_allclose(turned, compose(first[None], second[None])[0], atol=1e-9)


def test_cholesky_solves_and_refuses_what_is_not_definite():
    rng = np.random.default_rng(4)
    root = rng.standard_normal((9, 9))
    matrix, right = root @ root.T + np.eye(9), rng.standard_normal(9)
    solution = right.copy()
    assert kernels.solve_in_place(np.tril(matrix), solution)
    np.testing.assert_allclose(matrix @ solution, right, atol=1e-9)
    assert not kernels.solve_in_place(-np.eye(3), np.ones(3))


def test_a_fit_ends_where_the_plain_gradient_vanishes():
    problem = blended_problem()
    poses, places = some_poses(2)
    fitted = fit_clicks(problem, poses, places, iterations=200, tolerance=1e-12)
    posed = pose_landmarks(problem.rig, fitted.pose, fitted.translation)
    np.testing.assert_allclose(fitted.energy, click_energy(problem, fitted.pose, posed), rtol=1e-9)
    _, gradient = normal_equations(problem, fitted.pose, posed)
    _, first = normal_equations(problem, poses, pose_landmarks(problem.rig, poses, places))
    assert np.abs(gradient).max() < 1e-3 * np.abs(first).max()


def test_arguments_are_left_as_they_were():
    problem = blended_problem()
    poses, places = some_poses(2)
    before = poses.copy(), places.copy(), problem.pixels.copy()
    fit_clicks(problem, poses, places, iterations=3)
    for kept, now in zip(before, (poses, places, problem.pixels), strict=True):
        np.testing.assert_array_equal(kept, now)


def test_each_pose_of_a_batch_may_have_its_own_clicks():
    problem = blended_problem()
    poses, places = some_poses(2)
    shifted = np.stack([problem.pixels, problem.pixels + 5.0])
    together = fit_clicks(dataclasses.replace(problem, pixels=shifted), poses, places, iterations=5)
    alone = fit_clicks(
        dataclasses.replace(problem, pixels=shifted[1]), poses[1:], places[1:], iterations=5
    )
    np.testing.assert_allclose(together.pose[1], alone.pose[0])


def test_a_person_behind_the_camera_has_no_energy_to_compare():
    problem = blended_problem()
    poses, places = some_poses(1)
    fitted = fit_clicks(problem, poses, places * [1.0, 1.0, -1.0], iterations=3)
    assert np.isinf(fitted.energy[0])
