"""A prior on the shape in matrix, gradient and searches."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.shape_terms import NOTHING_KNOWN, ShapePrior, population_prior
from fitter.optimizer.free_space import free_space
from fitter.optimizer.joint_equations import joint_equations
from fitter.optimizer.search import minimize_gauss_newton, minimize_simplex
from tests.unit.optimizer.rendered_scene import RenderedScene, rendered_scene


def ignore(_):
    return None


@pytest.fixture(scope="module")
def scene() -> RenderedScene:
    return rendered_scene(0)


def told(scene: RenderedScene) -> ShapePrior:
    """Somebody a standard deviation off along every axis, with a correlation."""
    n = len(scene.start.shape)
    precision = 20.0 * population_prior(n).precision
    precision[1, 2] = precision[2, 1] = 5.0
    return ShapePrior(mean=np.append(0.0, np.ones(n - 1)), precision=precision)


def test_gradient_and_matrix_hold_the_prior_s_own(scene):
    other = replace(scene.person, shape_prior=told(scene))
    shape = scene.start.shape
    space = free_space(NOTHING_KNOWN.held, shape)
    told_so, plain = (
        joint_equations(each, each.evaluate([scene.start]), space) for each in (other, scene.person)
    )
    more, fewer = other.shape_prior, scene.person.shape_prior
    # The height is not among what may change.
    np.testing.assert_allclose(
        told_so.shared - plain.shared, (more.precision - fewer.precision)[1:, 1:], atol=1e-9
    )
    np.testing.assert_allclose(
        told_so.shared_gradient - plain.shared_gradient,
        (more.slope(shape) - fewer.slope(shape))[1:],
        atol=1e-9,
    )


def test_both_optimisers_lower_the_energy_of_the_prior(scene):
    other = replace(scene.person, shape_prior=told(scene))
    start = [scene.start]
    begin = other.evaluate(start).energies["shape_prior"]
    newton = minimize_gauss_newton(other, start, max_evaluations=60, on_energies=ignore)
    assert newton.candidate.energies["shape_prior"] < 0.2 * begin
    assert np.abs(newton.candidate.shape[1:] - 1.0).mean() < 0.4
    simplex = minimize_simplex(other, start, max_evaluations=120, on_energies=ignore)
    assert simplex.candidate.energies["shape_prior"] < begin
