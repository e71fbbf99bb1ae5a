"""Unknowns of rows besides the body, eliminated from the matrix of both, in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.body.tangent import linearise
from fitter.energies.correspondence_lines import line_energy
from fitter.energies.objective import Candidate, Objective
from fitter.energies.rows import PositionRows, thinned
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.optimizer.normal_equations import (
    MATRIX_ROWS,
    RowsWithNuisance,
    normal_equations,
    nuisance_covariance,
    position_row_jacobian,
    support_points,
    without_nuisance,
)
from fitter.optimizer.search import with_lines_about
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


def _outline_rows(objective: Objective, candidate: Candidate) -> list[PositionRows]:
    (outline,) = (term for term in objective.terms if term.name == "silhouette")
    return [rows for rows in outline.rows(candidate) if isinstance(rows, PositionRows)]


def _with_nuisance(name: str, objective: Objective, candidate: Candidate) -> list[RowsWithNuisance]:
    frame = linearise(objective.operators.tangent, candidate.parameters)
    points = support_points(objective, candidate)
    found: list[RowsWithNuisance] = []
    for rows in (rows for term in objective.terms for rows in term.rows(candidate)):
        if isinstance(rows, PositionRows) and rows.nuisance and rows.nuisance.name == name:
            few, on = thinned(rows, MATRIX_ROWS), points[rows.support]
            assert few.nuisance is not None
            jacobian = position_row_jacobian(few, frame, on.attachments, on.positions)
            found.append(
                RowsWithNuisance(by_body=jacobian, weights=few.weights, nuisance=few.nuisance)
            )
    return found


@pytest.mark.parametrize(
    ("name", "lines", "kinds"), [("ease", False, 2), ("ease", True, 1), ("tilt", True, 1)]
)
def test_eliminating_other_unknowns_is_inverting_the_matrix_of_both(name, lines, kinds):
    objective, candidate = _dressed(0.8, lines=lines)
    found = _with_nuisance(name, objective, candidate)
    assert len(found) == kinds
    by_body = np.vstack([rows.by_body for rows in found])
    columns = by_body.shape[1]
    # Whatever else is known of the body.
    root = np.random.default_rng(2).standard_normal((2 * columns, columns))
    other = root.T @ root
    both = np.hstack([by_body, np.vstack([rows.by_nuisance for rows in found])])
    matrix = both.T @ both
    matrix[:columns, :columns] += other
    known = found[0].nuisance.known
    matrix[columns:, columns:] += known.T @ known
    expected = np.linalg.inv(matrix)
    free = without_nuisance(found)
    body = np.linalg.inv(other + free.T @ free)
    np.testing.assert_allclose(body, expected[:columns, :columns], rtol=1e-6, atol=1e-9)
    if kinds == 1:
        np.testing.assert_allclose(
            nuisance_covariance(found[0], body),
            expected[columns:, columns:],
            rtol=1e-6,
            atol=1e-9,
        )


def test_rows_without_weight_say_nothing_of_other_unknowns():
    (rows,) = _with_nuisance("ease", *_dressed(0.8, lines=True))
    nothing = replace(
        rows, weights=np.zeros_like(rows.weights), by_body=np.zeros_like(rows.by_body)
    )
    np.testing.assert_array_equal(without_nuisance([nothing]), 0.0)


def test_lines_push_as_the_slope_of_an_energy_whose_offset_follows():
    objective, candidate = _dressed(1.0, lines=True)
    lines, scales = objective.evidence.lines, objective.scales
    assert lines is not None
    wider = np.random.default_rng(0).normal(0.0, 1.0, candidate.vertices.shape)
    push = sum(
        float(((rows.weights * rows.residuals)[:, None] * along).sum())
        for rows in _outline_rows(objective, candidate)
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
        "fitter.optimizer.normal_equations.without_nuisance",
        lambda kinds: (
            np.concatenate([rows.by_body for rows in kinds])
            if kinds[0].nuisance.name == "ease"
            else without_nuisance(kinds)
        ),
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
    assert not _with_nuisance("ease", objective, candidate)
    matrix, _ = normal_equations(objective, candidate)
    again, _ = normal_equations(objective, candidate, marginal=True)
    np.testing.assert_array_equal(matrix, again)
