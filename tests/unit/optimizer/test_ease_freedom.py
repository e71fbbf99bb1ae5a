from dataclasses import replace

import numpy as np
import pytest

from fitter.body.tangent import linearise
from fitter.energies.correspondence_lines import line_energy
from fitter.energies.objective import Candidate, Objective
from fitter.energies.rows import PositionRows, thinned
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.optimizer.ease_freedom import with_free_ease
from fitter.optimizer.normal_equations import MATRIX_ROWS, normal_equations, outline_rows
from fitter.optimizer.renewed_lines import with_lines_about
from fitter.optimizer.row_jacobians import position_row_jacobian
from fitter.optimizer.uncertainty import certainty, shape_covariance
from fitter.render.rasterizer import render
from tests.unit.optimizer.rendered_scene import of_person, rendered_scene


def _dressed(cloth: float | None, *, lines: bool = False) -> tuple[Objective, Candidate]:
    """The body of a picture said to be cloth all over, with some probability."""
    scene = rendered_scene(1)
    mask = scene.objective.evidence.silhouette.mask
    of_cloth = None if cloth is None else np.full(mask.shape, cloth, dtype=np.float32)
    objective = replace(
        scene.objective,
        evidence=replace(
            scene.objective.evidence, silhouette=silhouette_evidence(mask, cloth=of_cloth)
        ),
    )
    if lines:
        objective = with_lines_about(objective, scene.truth, scene.display)
    return objective, objective.evaluate(scene.truth)


def _ease_rows(objective: Objective, candidate: Candidate) -> list[PositionRows]:
    return [rows for rows in outline_rows(objective, candidate) if rows.of_ease]


@pytest.mark.parametrize("lines", [False, True])
def test_the_rows_are_those_of_body_and_offset_together_without_the_offset(lines):
    objective, candidate = _dressed(0.8, lines=lines)
    frame = linearise(objective.operators.tangent, candidate.parameters)
    vertices = objective.operators.tangent.vertices
    kinds = [thinned(rows, MATRIX_ROWS) for rows in _ease_rows(objective, candidate)]
    assert len(kinds) == (1 if lines else 2)
    eases = [
        (position_row_jacobian(rows, frame, vertices, candidate.vertices), rows) for rows in kinds
    ]
    body = np.vstack([jacobian for jacobian, _ in eases])
    roots = np.sqrt(np.concatenate([rows.weights for rows in kinds]))
    together = np.hstack([body, roots[:, None]])
    joint = together.T @ together
    joint[-1, -1] += objective.scales.ease_common_spread**-2
    expected = joint[:-1, :-1] - np.outer(joint[:-1, -1], joint[-1, :-1]) / joint[-1, -1]
    free = with_free_ease(eases, objective.scales)
    np.testing.assert_allclose(free.T @ free, expected, rtol=1e-9, atol=1e-9 * expected.max())


def test_rows_without_weight_stay_as_they_are():
    objective, candidate = _dressed(0.8, lines=True)
    (rows,) = _ease_rows(objective, candidate)
    nothing = replace(rows, weights=np.zeros_like(rows.weights))
    jacobian = np.ones((len(rows.weights), 2))
    found = with_free_ease([(jacobian, nothing)], objective.scales)
    np.testing.assert_array_equal(found, jacobian)


def test_lines_push_as_the_slope_of_an_energy_whose_offset_follows():
    objective, candidate = _dressed(1.0, lines=True)
    lines, scales = objective.evidence.lines, objective.scales
    assert lines is not None
    wider = np.random.default_rng(0).normal(0.0, 1.0, candidate.vertices.shape)
    push = sum(
        float(((rows.weights * rows.residuals)[:, None] * along).sum())
        for rows in outline_rows(objective, candidate)
        for along in [np.einsum("kqi,kqi->kq", rows.derivatives, wider[rows.points])]
    )
    step = 1e-6

    def energy(by: float) -> float:
        vertices = candidate.vertices + by * wider
        moved = render(vertices, objective.operators.model.triangles, objective.evidence.camera)
        return line_energy(moved, lines, scales)

    slope = (energy(step) - energy(-step)) / (2.0 * step)
    assert push == pytest.approx(slope, rel=1e-4)


@pytest.mark.parametrize("lines", [False, True])
def test_a_shape_is_less_certain_under_an_ease_that_is_not_known(lines, monkeypatch):
    objective, candidate = _dressed(1.0, lines=lines)
    person = of_person(objective)
    seen = person.evaluate([candidate])
    free = shape_covariance(*certainty(person, seen), height_variance=0.0)
    monkeypatch.setattr(
        "fitter.optimizer.normal_equations.with_free_ease",
        lambda eases, _: np.concatenate([jacobian for jacobian, _ in eases]),
    )
    held = shape_covariance(*certainty(person, seen), height_variance=0.0)
    gain = np.linalg.eigvalsh((free - held)[1:, 1:])
    assert gain.min() > -1e-9
    assert gain.max() > 0.002


def test_only_lines_let_the_ease_go_while_a_body_is_searched_for():
    for lines in (False, True):
        objective, candidate = _dressed(1.0, lines=lines)
        search, _ = normal_equations(objective, candidate)
        marginal, _ = normal_equations(objective, candidate, marginal=True)
        assert np.array_equal(search, marginal) is lines


def test_tight_clothes_have_no_rows_of_ease():
    objective, candidate = _dressed(None)
    assert not _ease_rows(objective, candidate)
    matrix, _ = normal_equations(objective, candidate)
    again, _ = normal_equations(objective, candidate, marginal=True)
    np.testing.assert_array_equal(matrix, again)
