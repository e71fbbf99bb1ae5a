import numpy as np
import pytest

from tests.evaluation.outline_limit import (
    LEVELS,
    SOLES_AND_CROWN,
    foretelling_errors,
    widths_at_levels,
)


def test_a_cone_is_as_wide_as_its_height_says():
    heights = np.linspace(0.0, 1.6, 4000)
    sides = np.stack([0.5 * (1.6 - heights), heights, np.zeros_like(heights)], axis=1)
    cone = np.concatenate([sides, sides * [-1.0, 1.0, 1.0]])
    middle = (np.arange(LEVELS)[SOLES_AND_CROWN] + 0.5) / LEVELS
    np.testing.assert_allclose(widths_at_levels(cone[None], 0)[0], 1.6 * (1.0 - middle), atol=0.011)
    assert not widths_at_levels(cone[None], 2).any()


def test_what_is_linear_in_the_widths_is_foretold_and_noise_is_not():
    rng = np.random.default_rng(0)
    widths = rng.normal(scale=0.1, size=(600, 5))
    noise = rng.normal(size=600)
    wanted = np.stack([90.0 + widths @ [100.0, -50.0, 20.0, 0.0, 5.0], noise], axis=1)
    away = foretelling_errors(widths, wanted, held_out=200)
    assert away.shape == (200, 2)
    assert np.abs(away[:, 0]).mean() < 0.05
    assert np.std(away[:, 1]) == pytest.approx(np.std(noise[:200]), rel=0.1)
