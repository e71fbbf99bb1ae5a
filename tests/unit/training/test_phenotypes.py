import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fitter.training.makehuman.body_space import (
    average_traits,
    source_vertices,
    target_coefficients,
)
from fitter.training.makehuman.phenotypes import (
    ANCHORS,
    free_axes,
    hat_slopes,
    hat_weights,
    macro_coefficients,
    macro_targets,
)
from tests.unit.training.makehuman_data import body_space, needs_makehuman

EVEN = np.full(3, 1 / 3)


@given(st.floats(0.0, 1.0), st.sampled_from(["muscle", "height", "cupsize"]))
def test_hat_weights_sum_to_one_and_reproduce_the_value(value: float, axis: str):
    weights = hat_weights(value, ANCHORS[axis])
    assert weights.min() >= 0.0
    assert weights.sum() == pytest.approx(1.0)
    assert weights @ np.array(ANCHORS[axis]) == pytest.approx(value, abs=1e-12)


def test_hat_slopes_are_the_derivative_of_the_weights_between_anchors():
    for value in (0.1, 0.4, 0.7, 0.95):
        step = 1e-6
        above = hat_weights(value + step, ANCHORS["muscle"])
        below = hat_weights(value - step, ANCHORS["muscle"])
        np.testing.assert_allclose(
            hat_slopes(value, ANCHORS["muscle"]), (above - below) / (2 * step), atol=1e-6
        )


@pytest.mark.parametrize("gender", ["female", "male"])
def test_each_family_of_macro_targets_shares_out_one(gender: str):
    targets = macro_targets(gender)
    values = dict.fromkeys(free_axes(gender), 0.3)
    coefficients, _ = macro_coefficients(targets, age=0.8, ancestry=EVEN, values=values)
    families = {"universal": 1.0, "/height/": 1.0, "/proportions/": 1.0}
    for family, total in families.items():
        members = [family in name for name in targets.names]
        assert coefficients[members].sum() == pytest.approx(total)
    ancestry = [name.startswith("macrodetails/african") for name in targets.names]
    assert coefficients[ancestry].sum() == pytest.approx(1 / 3)


def test_at_an_anchor_only_the_targets_of_that_phenotype_act():
    targets = macro_targets("male")
    values = {"muscle": 1.0, "weight": 0.0, "height": 1.0, "proportions": 0.0}
    ancestry = np.array([0.0, 1.0, 0.0])
    coefficients, _ = macro_coefficients(targets, age=1.0, ancestry=ancestry, values=values)
    acting = {targets.names[k] for k in np.flatnonzero(coefficients)}
    assert acting == {
        "macrodetails/asian-male-old",
        "macrodetails/universal-male-old-maxmuscle-minweight",
        "macrodetails/height/male-old-maxmuscle-minweight-maxheight",
        "macrodetails/proportions/male-old-maxmuscle-minweight-idealproportions",
    }


@needs_makehuman
@pytest.mark.parametrize("gender", ["female", "male"])
def test_coefficients_have_the_derivative_that_finite_differences_give(gender: str):
    space = body_space(gender)
    traits = average_traits()
    generator = np.random.default_rng(1)
    parameters = space.neutral + 0.4 * (space.upper - space.lower) * generator.uniform(
        -1, 1, len(space.neutral)
    )
    _, derivative = target_coefficients(space, traits, parameters)
    step = 1e-6
    for parameter in range(len(parameters)):
        nudge = step * np.eye(len(parameters))[parameter]
        above, _ = target_coefficients(space, traits, parameters + nudge)
        below, _ = target_coefficients(space, traits, parameters - nudge)
        np.testing.assert_allclose(
            derivative[:, parameter], (above - below) / (2 * step), atol=1e-8
        )


@needs_makehuman
def test_average_bodies_are_symmetric_and_men_are_taller_than_women():
    heights = {}
    for gender in ("female", "male"):
        space = body_space(gender)
        body = space.base.body(source_vertices(space, average_traits(), space.neutral))
        mirrored = body[space.base.mirror] * [-1.0, 1.0, 1.0]
        np.testing.assert_allclose(mirrored, body, atol=1e-6)
        heights[gender] = np.ptp(body[:, 1])
    assert 1.6 < heights["female"] < heights["male"] < 2.0
