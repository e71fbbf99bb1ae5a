from dataclasses import replace

import numpy as np
import pytest

from fitter.body.tangent import linearise
from fitter.energies.objective import Candidate, Objective
from fitter.energies.rows import PositionRows, thinned
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.optimizer import uncertainty
from fitter.optimizer.ease_freedom import information_lost_to_ease
from fitter.optimizer.normal_equations import MATRIX_ROWS, normal_equations, outline_rows
from fitter.optimizer.renewed_lines import with_lines_about
from fitter.optimizer.row_jacobians import position_row_jacobian
from fitter.optimizer.uncertainty import shape_covariance
from tests.unit.optimizer.rendered_scene import rendered_scene


def _dressed(
    cloth: float | None, *, lines: bool = False, boundless: bool = False
) -> tuple[Objective, Candidate]:
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
    if boundless:
        objective = replace(objective, scales=replace(objective.scales, ease_reach=1e9))
    if lines:
        objective = with_lines_about(objective, scene.truth, scene.display)
    return objective, objective.evaluate(scene.truth)


def _ease_rows(objective: Objective, candidate: Candidate) -> list[PositionRows]:
    return [rows for rows in outline_rows(objective, candidate) if rows.of_ease]


@pytest.mark.parametrize("lines", [False, True])
def test_the_covariance_is_that_of_body_and_offset_together(lines):
    objective, candidate = _dressed(0.8, lines=lines)
    matrix, _ = normal_equations(objective, candidate)
    frame = linearise(objective.instruments.tangent, candidate.parameters)
    vertices = objective.instruments.tangent.vertices
    few = [thinned(rows, MATRIX_ROWS) for rows in _ease_rows(objective, candidate)]
    assert len(few) == (1 if lines else 2)
    body = np.vstack([position_row_jacobian(e, frame, vertices, candidate.vertices) for e in few])
    offset = np.sqrt(np.concatenate([each.weights for each in few]))[:, None]
    joint = np.hstack([body, offset]).T @ np.hstack([body, offset])
    joint[:-1, :-1] = matrix
    joint[-1, -1] += 1.0 / objective.scales.ease_spread**2
    # The height, first of the shape, is held; the ridge is that of the covariance.
    first = len(matrix) - len(candidate.parameters.shape)
    free = np.delete(np.arange(len(joint)), first)
    joint = joint[np.ix_(free, free)]
    joint[:-1, :-1] += 1e-9 * np.eye(len(joint) - 1)
    expected = np.linalg.inv(joint)[first:-1, first:-1]
    found = shape_covariance(objective, candidate, height_variance=0.0)[1:, 1:]
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-9)


def test_the_offset_pulls_as_a_mean_ease_that_is_wider():
    objective, candidate = _dressed(1.0, boundless=True)
    scales = objective.scales
    wider = replace(objective, scales=replace(scales, ease_mean=scales.ease_mean + 1.0))
    (matrix, gradient), (_, pulled) = (normal_equations(e, candidate) for e in (objective, wider))
    weights = sum(float(rows.weights.sum()) for rows in _ease_rows(objective, candidate))
    own = weights + 1.0 / scales.ease_spread**2
    pull = pulled - gradient
    # Of information in deviations of the body; few rows and the linear-blend tangent stand for all
    # rows and the body's own derivative.
    whitening = np.linalg.inv(np.linalg.cholesky(matrix + 1e-9 * np.eye(len(matrix))))
    lost = whitening @ information_lost_to_ease(objective, candidate) @ whitening.T
    expected = whitening @ pull
    assert np.trace(lost) == pytest.approx(expected @ expected / own, rel=0.25)
    assert expected @ lost @ expected > 0.8 * np.trace(lost) * (expected @ expected)


@pytest.mark.parametrize("lines", [False, True])
def test_a_free_offset_takes_information_and_never_more_than_there_is(lines):
    objective, candidate = _dressed(1.0, lines=lines)
    matrix, _ = normal_equations(objective, candidate)
    lost = information_lost_to_ease(objective, candidate)
    scale = np.sqrt(matrix.diagonal() + 1e-9)
    of_rest = np.linalg.eigvalsh((matrix - lost) / np.outer(scale, scale))
    assert np.trace(lost / np.outer(scale, scale)) > 0.05
    assert of_rest.min() > -1e-9


def test_a_shape_is_less_certain_under_an_ease_that_is_not_known(monkeypatch):
    objective, candidate = _dressed(1.0)
    found = shape_covariance(objective, candidate, height_variance=0.0)[1:, 1:]
    monkeypatch.setattr(uncertainty, "information_lost_to_ease", lambda *_: 0.0)
    known = shape_covariance(objective, candidate, height_variance=0.0)[1:, 1:]
    gain = np.linalg.eigvalsh(found - known)
    assert gain.min() > -1e-9
    assert gain.max() > 0.002


def test_tight_clothes_have_no_offset(monkeypatch):
    objective, candidate = _dressed(None)
    found = shape_covariance(objective, candidate, height_variance=0.3)
    bare, seen = _dressed(0.0)
    assert not information_lost_to_ease(bare, seen).any()

    def never(*_):
        pytest.fail("tight clothes have no ease")

    monkeypatch.setattr(uncertainty, "information_lost_to_ease", never)
    again = shape_covariance(objective, candidate, height_variance=0.3)
    np.testing.assert_array_equal(found, again)
    assert not _ease_rows(objective, candidate)
