"""A term in the list is all that an energy needs: it is summed, pulls and shapes the step."""

import numpy as np
import pytest

from fitter.energies import objective as objectives
from fitter.energies.rows import Nuisance, PositionRows, Support
from fitter.energies.terms import SeenBody, Term, terms_of
from fitter.optimizer.free_space import moved
from fitter.optimizer.normal_equations import normal_equations
from tests.unit.optimizer.rendered_scene import rendered_scene

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
