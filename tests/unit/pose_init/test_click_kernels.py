"""The compiled fit to clicks against the plain one and against finite differences."""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from fitter.detection.detector import DetectedSlants, LimbSlant
from fitter.numerics.damped_descent import Descent, Offer, damped_steps, descend
from fitter.numerics.rotations import compose
from fitter.pose_init import _click_kernels as kernels
from fitter.pose_init.click_fit import FLOOR, fit_clicks, terms_of, unknowns_of
from fitter.pose_init.click_problem import ClickProblem, click_problem
from fitter.pose_init.landmark_rig import LandmarkRig, rig_arrays
from fitter.vocabulary.choices import Facing
from tests.unit.pose_init.plain_clicks import (
    click_energy,
    landmark_jacobian,
    normal_equations,
    pose_landmarks,
)
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
    rig, (terms,) = rig_arrays(problem.rig), terms_of(problem, 1)
    posed, energy = kernels.evaluate(rig, terms, pose, place)
    matrix, gradient = kernels.normal_equations(rig, terms, unknowns_of(problem), pose, posed)
    return energy, matrix, gradient


@dataclass(frozen=True)
class Place:
    """A pose with its plain energy."""

    pose: np.ndarray
    translation: np.ndarray
    total: float


def plainly_fitted(
    problem: ClickProblem, pose: np.ndarray, translation: np.ndarray, *, iterations: int
) -> Descent[Place]:
    """The search by the loop of all searches, with terms in plain numpy."""
    turns = 3 * int(problem.turning.sum())

    def evaluated(pose: np.ndarray, translation: np.ndarray) -> Place:
        posed = pose_landmarks(problem.rig, pose[None], translation[None])
        return Place(pose, translation, float(click_energy(problem, pose[None], posed)[0]))

    def paraboloid(now: Place) -> Callable[[float], Offer[Place]]:
        posed = pose_landmarks(problem.rig, now.pose[None], now.translation[None])
        (matrix,), (gradient,) = normal_equations(problem, now.pose[None], posed)

        def taken(step: np.ndarray) -> Place:
            pose = now.pose.copy()
            turned = compose(step[:turns].reshape(-1, 3), pose[problem.turning])
            pose[problem.turning] = turned
            moved = now.translation + step[turns:] if problem.moving else now.translation
            return evaluated(pose, moved)

        return damped_steps(matrix, gradient, taken, floor=FLOOR)

    return descend(
        evaluated(pose, translation), paraboloid, max_evaluations=1 + iterations, settled=1e-3
    )


@pytest.mark.parametrize("moving", [True, False])
@pytest.mark.parametrize("iterations", [1, 4, 30])
def test_the_compiled_search_takes_the_steps_of_the_loop_of_all_searches(iterations, moving):
    problem = dataclasses.replace(blended_problem(), moving=moving)
    poses, places = some_poses(4)
    fitted = fit_clicks(problem, poses, places, iterations=iterations)
    for row in range(4):
        plain = plainly_fitted(problem, poses[row], places[row], iterations=iterations).point
        assert fitted.energy[row] == pytest.approx(plain.total, rel=1e-9)
        np.testing.assert_allclose(fitted.pose[row], plain.pose, atol=1e-6)
        np.testing.assert_allclose(fitted.translation[row], plain.translation, atol=1e-6)


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
        np.testing.assert_allclose(matrix, matrices[row], rtol=1e-9, atol=1e-7)


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
