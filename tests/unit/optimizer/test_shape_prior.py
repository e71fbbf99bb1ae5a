"""The prior of the shape, and that every term is walked through."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.energies import objective as objectives
from fitter.energies.rows import Nuisance, PositionRows, Support
from fitter.energies.shape_terms import NOTHING_KNOWN, ShapePrior, population_prior
from fitter.energies.terms import SeenBody, Term, terms_of
from fitter.optimizer.free_space import free_space, moved
from fitter.optimizer.joint_equations import joint_equations
from fitter.optimizer.normal_equations import normal_equations
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


PLACE_M, WEIGHT = np.array([0.1, -0.2, 2.5]), 1e4


def joints_drawn_to_a_place(support: Support, nuisance: Nuisance | None = None) -> Term:
    """½ w |x - place|² of all joints, or of what else a support has."""

    def points(seen: SeenBody) -> np.ndarray:
        return {
            Support.VERTICES: seen.vertices,
            Support.LANDMARKS: seen.landmarks,
            Support.SPHERES: seen.spheres,
            Support.JOINTS: seen.joints,
        }[support]

    def rows(seen: SeenBody) -> tuple[PositionRows, ...]:
        away = points(seen) - PLACE_M
        count = len(away)
        return (
            PositionRows(
                residuals=away.ravel(),
                weights=np.full(3 * count, WEIGHT),
                points=np.repeat(np.arange(count), 3)[:, None],
                derivatives=np.tile(np.eye(3), (count, 1))[:, None],
                support=support,
                nuisance=nuisance,
            ),
        )

    return Term(
        name="drawn",
        energy=lambda seen: 0.5 * WEIGHT * float(((points(seen) - PLACE_M) ** 2).sum()),
        rows=rows,
    )


@pytest.mark.parametrize("support", list(Support))
def test_a_term_added_to_the_list_is_summed_and_pulls_as_its_energy_falls(support, monkeypatch):
    scene = rendered_scene(1)
    plain = scene.objective.evaluate(scene.start)
    matrix, gradient = normal_equations(scene.objective, plain)
    term = joints_drawn_to_a_place(support)
    monkeypatch.setattr(objectives, "terms_of", lambda *picture: (*terms_of(*picture), term))
    found = scene.objective.evaluate(scene.start)
    assert found.energies == {**plain.energies, "drawn": term.energy(found)}
    with_term, pull = normal_equations(scene.objective, found)
    added = pull - gradient
    step = 1e-6 * np.random.default_rng(3).standard_normal(len(added))
    ahead, behind = (
        term.energy(scene.objective.see(moved(scene.start, sign * step))) for sign in (1.0, -1.0)
    )
    assert added @ step == pytest.approx(0.5 * (ahead - behind), rel=1e-4)
    more = with_term - matrix
    assert np.linalg.eigvalsh(more).min() > -1e-9 * np.linalg.eigvalsh(more).max()
    assert more[51:54, 51:54].trace() > 0.0


def test_every_energy_has_a_name_of_its_own():
    scene = rendered_scene(1)
    names = [term.name for term in scene.objective.terms]
    assert len(set(names)) == len(names)
    assert set(scene.objective.evaluate(scene.start).energies) == set(names)
