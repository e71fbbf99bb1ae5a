"""The slant energy against a closed form, and its rows against finite differences."""

import numpy as np
import pytest

from fitter.energies.landmarks import SlantEvidence, slant_energy, slant_rows
from fitter.pose_init.limbs import TRUNCATION

TOWARD = np.array([0.28, 0.0, 0.96])
LANDMARKS = np.array([[0.0, 0.0, 3.0], [0.1, 0.4, 3.2], [0.0, 0.8, 3.1]])


def evidence(reach_m: float, *, sigma_m: float = 0.05) -> SlantEvidence:
    """Of the limb from the first landmark to the second."""
    return SlantEvidence(
        ends=np.array([[0, 1]]),
        toward=TOWARD,
        reach_m=np.array([reach_m]),
        sigma_m=np.array([sigma_m]),
    )


def true_reach() -> float:
    return float((LANDMARKS[1] - LANDMARKS[0]) @ TOWARD)


def test_a_limb_that_reaches_as_told_costs_nothing():
    assert slant_energy(LANDMARKS, evidence(true_reach())) == pytest.approx(0.0, abs=1e-12)


def test_near_what_was_told_the_energy_is_half_a_square():
    assert slant_energy(LANDMARKS, evidence(true_reach() - 0.05)) == pytest.approx(0.5)


def test_far_from_it_the_energy_grows_linearly():
    near, far = (slant_energy(LANDMARKS, evidence(true_reach() - d)) for d in (0.5, 0.6))
    assert far - near == pytest.approx(TRUNCATION * 0.1 / 0.05)


@pytest.mark.parametrize("reach", [0.17, 0.5])
def test_rows_are_the_energys_gradient(reach):
    told = evidence(reach)
    rows = slant_rows(LANDMARKS, told)
    gradient = np.zeros_like(LANDMARKS)
    for weight, residual, points, derivatives in zip(
        rows.weights, rows.residuals, rows.points, rows.derivatives, strict=True
    ):
        np.add.at(gradient, points, weight * residual * derivatives)
    for index in np.ndindex(LANDMARKS.shape):
        step = np.zeros_like(LANDMARKS)
        step[index] = 1e-6
        slope = slant_energy(LANDMARKS + step, told) - slant_energy(LANDMARKS - step, told)
        assert gradient[index] == pytest.approx(slope / 2e-6, abs=1e-4)
