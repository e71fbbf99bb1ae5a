"""One shape in several pictures: the equations by their plain sum, and recovery of a known man."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.objective import JointCandidate, JointObjective
from fitter.energies.shape_terms import NOTHING_KNOWN, Attributes, KnownAttributes, population_prior
from fitter.optimizer.free_space import free_space
from fitter.optimizer.joint_equations import JointEquations, joint_equations
from fitter.optimizer.normal_equations import normal_equations
from fitter.optimizer.search import minimize_gauss_newton
from fitter.optimizer.uncertainty import body_information, certainty, shape_covariance
from tests.unit.optimizer.rendered_scene import RenderedScene, of_person, rendered_scene

FREE = 5


def ignore(_):
    return None


@pytest.fixture(scope="module")
def scenes() -> list[RenderedScene]:
    """One man from the front and from the side."""
    return [
        rendered_scene(0, shape_seed=7),
        rendered_scene(1, shape_seed=7, turned=np.radians(80.0)),
    ]


def joint_of(
    scenes: Sequence[RenderedScene],
    *,
    weight: float = 1.0,
    attributes: KnownAttributes = NOTHING_KNOWN,
) -> JointObjective:
    objectives = [scene.objective for scene in scenes]
    return of_person(*objectives, weight=weight, attributes=attributes)


def a_sum(n: int, *, held: bool) -> KnownAttributes:
    """The sum of the second and third coefficient: held at 0.3, or known to be 0.3 ± 0.1."""
    row = np.zeros((1, n))
    row[0, 1:3] = 1.0
    sums = Attributes(
        measure=lambda shape: row @ shape, jacobian=lambda _: row.copy(), values=np.array([0.3])
    )
    if held:
        return replace(NOTHING_KNOWN, held=sums)
    return replace(NOTHING_KNOWN, uncertain=sums, standard_errors=np.array([0.1]))


def newton_decrement(objective: JointObjective, candidate: JointCandidate) -> float:
    """What an undamped step promises, nats: 0 where the gradient is."""
    space = free_space(objective.attributes.held, candidate.shape)
    return joint_equations(objective, candidate, space).step(0.0).promised


def random_equations(seed: int) -> JointEquations:
    rng = np.random.default_rng(seed)
    sizes = (4, 4, 4)
    roots = [rng.standard_normal((30, size + FREE)) for size in sizes]
    squares = [root.T @ root for root in roots]
    return JointEquations(
        own=tuple(each[:-FREE, :-FREE] for each in squares),
        border=tuple(each[:-FREE, -FREE:] for each in squares),
        shared=sum(each[-FREE:, -FREE:] for each in squares) + np.eye(FREE),
        own_gradients=tuple(rng.standard_normal(size) for size in sizes),
        shared_gradient=rng.standard_normal(FREE),
        directions=np.eye(FREE),
    )


def dense(equations: JointEquations) -> tuple[np.ndarray, np.ndarray]:
    """The whole matrix and gradient: each picture's unknowns, then the shape's."""
    sizes = [len(each) for each in equations.own]
    count = sum(sizes) + len(equations.shared)
    matrix = np.zeros((count, count))
    begin = 0
    shared = slice(sum(sizes), count)
    for own, border in zip(equations.own, equations.border, strict=True):
        span = slice(begin, begin + len(own))
        matrix[span, span] = own
        matrix[span, shared], matrix[shared, span] = border, border.T
        begin += len(own)
    matrix[shared, shared] = equations.shared
    return matrix, np.concatenate([*equations.own_gradients, equations.shared_gradient])


@pytest.mark.parametrize("damping", [0.0, 0.01, 10.0])
def test_a_step_by_the_schur_complement_is_that_of_the_whole_matrix(damping):
    equations = random_equations(3)
    matrix, gradient = dense(equations)
    expected = np.linalg.solve(matrix + damping * np.diag(matrix.diagonal()), -gradient)
    step = equations.step(damping)
    np.testing.assert_allclose(np.concatenate([*step.own, step.shape]), expected, rtol=1e-6)
    promised = -(gradient @ expected + 0.5 * expected @ matrix @ expected)
    assert step.promised == pytest.approx(promised)


def test_the_energy_is_the_weighted_sum_with_what_is_known_once(scenes):
    known = a_sum(len(scenes[0].start.shape), held=False)
    objective = joint_of(scenes, weight=0.7, attributes=known)
    bodies = [scene.truth for scene in scenes]
    found = objective.evaluate(bodies)
    alone = [scene.objective.evaluate(scene.truth) for scene in scenes]
    prior = objective.shape_prior.energy(bodies[0].shape)
    expected = 0.7 * sum(each.total for each in alone) + prior
    off = (bodies[0].shape[1:3].sum() - 0.3) / 0.1
    assert found.total == pytest.approx(expected + 0.5 * off**2)
    assert found.energies["attributes"] == pytest.approx(0.5 * off**2)


def test_the_blocks_are_the_sums_of_those_of_the_pictures(scenes):
    known = a_sum(len(scenes[0].start.shape), held=False)
    objective = joint_of(scenes, weight=0.7, attributes=known)
    candidate = objective.evaluate(
        [replace(scene.start, shape=scenes[0].truth.shape) for scene in scenes]
    )
    space = free_space(NOTHING_KNOWN.held, candidate.shape)
    equations = joint_equations(objective, candidate, space)
    n, directions = len(candidate.shape), space.directions
    matrix, gradient = population_prior(n).precision, population_prior(n).slope(candidate.shape)
    row = np.zeros(n)
    row[1:3] = 10.0
    matrix = matrix + np.outer(row, row)
    gradient = gradient + row * 10.0 * (candidate.shape[1:3].sum() - 0.3)
    for number, (view, seen) in enumerate(zip(objective.views, candidate.views, strict=True)):
        of_view, slope = normal_equations(view, seen)
        np.testing.assert_allclose(equations.own[number], 0.7 * of_view[:-n, :-n])
        np.testing.assert_allclose(equations.border[number], 0.7 * of_view[:-n, -n:] @ directions)
        np.testing.assert_allclose(equations.own_gradients[number], 0.7 * slope[:-n])
        matrix = matrix + 0.7 * of_view[-n:, -n:]
        gradient = gradient + 0.7 * slope[-n:]
    np.testing.assert_allclose(equations.shared, directions.T @ matrix @ directions)
    np.testing.assert_allclose(equations.shared_gradient, gradient @ directions)


def test_a_step_in_one_picture_is_that_of_its_whole_matrix(scenes):
    objective = joint_of(scenes[:1])
    candidate = objective.evaluate([scenes[0].start])
    space = free_space(NOTHING_KNOWN.held, candidate.shape)
    matrix, gradient = normal_equations(objective.views[0], candidate.views[0])
    n = len(candidate.shape)
    matrix[-n:, -n:] += objective.shape_prior.precision
    gradient[-n:] += objective.shape_prior.slope(candidate.shape)
    free = np.delete(np.arange(len(matrix)), len(matrix) - n)
    damped = matrix[np.ix_(free, free)]
    damped = damped + np.diag(0.01 * damped.diagonal())
    step = joint_equations(objective, candidate, space).step(0.01)
    np.testing.assert_allclose(
        np.concatenate([*step.own, step.shape]),
        np.linalg.solve(damped, -gradient[free]),
        rtol=1e-4,
        atol=1e-6,
    )


def test_the_joint_minimum_is_level_below_the_truth_and_nearer_to_the_man_than_one_picture_s(
    scenes,
):
    objective = joint_of(scenes)
    start = [scene.start for scene in scenes]
    found = minimize_gauss_newton(objective, start, max_evaluations=60, on_energies=ignore)
    assert found.converged
    assert found.candidate.total < objective.evaluate([scene.truth for scene in scenes]).total
    # Level but for the roughness that pixels make: 226 and 0.07 nats are measured.
    assert newton_decrement(objective, objective.evaluate(start)) > 100.0
    assert newton_decrement(objective, found.candidate) < 0.5
    one, other = found.candidate.bodies
    np.testing.assert_array_equal(one.shape, other.shape)
    assert np.linalg.norm(one.pose[0] - other.pose[0]) > 1.0
    for scene, body in zip(scenes, found.candidate.bodies, strict=True):
        assert scene.objective.overlap(scene.objective.evaluate(body)) > 0.96
        alone = minimize_gauss_newton(
            scene.person, [scene.start], max_evaluations=60, on_energies=ignore
        )
        assert scene.shape_error_mm(body) < scene.shape_error_mm(alone.candidate.bodies[0])


def test_the_order_of_pictures_changes_nothing(scenes):
    bodies = [replace(scene.start, shape=scenes[0].truth.shape) for scene in scenes]
    one, other = (
        minimize_gauss_newton(
            joint_of(scenes[::step]), bodies[::step], max_evaluations=2, on_energies=ignore
        )
        for step in (1, -1)
    )
    np.testing.assert_allclose(one.candidate.shape, other.candidate.shape, atol=1e-6)
    assert np.abs(one.candidate.shape - bodies[0].shape).max() > 0.05


def test_what_is_held_stays(scenes):
    known = a_sum(len(scenes[0].start.shape), held=True)
    shape = scenes[0].truth.shape.copy()
    shape[1:3] += 0.5 * (0.3 - shape[1:3].sum())
    bodies = [replace(scene.start, shape=shape) for scene in scenes]
    objective = joint_of(scenes, attributes=known)
    found = minimize_gauss_newton(objective, bodies, max_evaluations=20, on_energies=ignore)
    assert found.candidate.shape[0] == shape[0]
    assert found.candidate.shape[1:3].sum() == pytest.approx(0.3, abs=1e-3)
    assert np.abs(found.candidate.shape - shape).max() > 0.05
    for certain in certainty(objective, found.candidate):
        covariance = shape_covariance(certain, height_variance=0.0)
        assert np.abs(covariance[1] + covariance[2]).max() < 1e-9
        assert covariance[4, 4] > 0.0


def test_covariance_and_height_response_are_those_of_the_whole_information(scenes):
    objective = joint_of(scenes, weight=0.8)
    truth = objective.evaluate([scene.truth for scene in scenes])
    certain = certainty(objective, truth)
    n = len(scenes[0].truth.shape)
    parts = [
        0.8 * body_information(view, seen)
        for view, seen in zip(objective.views, truth.views, strict=True)
    ]
    own = [part[:-n, :-n] for part in parts]
    equations = JointEquations(
        own=tuple(own),
        border=tuple(part[:-n, -n + 1 :] for part in parts),
        shared=sum(part[-n + 1 :, -n + 1 :] for part in parts)
        + objective.shape_prior.precision[1:, 1:],
        own_gradients=tuple(np.zeros(len(each)) for each in own),
        shared_gradient=np.zeros(n - 1),
        directions=np.eye(n - 1),
    )
    whole = np.linalg.inv(dense(equations)[0])
    size = len(own[0])
    for number, each in enumerate(certain):
        span = slice(number * size, (number + 1) * size)
        np.testing.assert_allclose(each.covariance[:size, :size], whole[span, span], atol=1e-9)
        np.testing.assert_allclose(
            each.covariance[:size, -n + 1 :], whole[span, 2 * size :], atol=1e-9
        )
        np.testing.assert_allclose(
            each.covariance[-n + 1 :, -n + 1 :], whole[2 * size :, 2 * size :], atol=1e-9
        )
    by_height = np.concatenate(
        [
            *(part[:-n, -n] for part in parts),
            sum(part[-n + 1 :, -n] for part in parts) + objective.shape_prior.precision[1:, 0],
        ]
    )
    for each in certain:
        assert each.height_response[0] == 1.0
        np.testing.assert_allclose(
            each.height_response[1:], -(whole @ by_height)[2 * size :], atol=1e-9
        )
        assert np.abs(each.height_response[1:]).max() > 0.01
