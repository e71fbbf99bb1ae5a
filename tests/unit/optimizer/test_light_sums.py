"""The compiled sums of the search for the light beside Eq. 1 and its derivatives point by point."""

import numpy as np
import pytest

from fitter.numerics.robust import geman_mcclure, geman_mcclure_weights
from fitter.optimizer.light_solve import light_columns
from fitter.optimizer.lit_surface import LightEstimate, LightSums, LitSurface
from fitter.parameters import Light, Reflectance
from fitter.render.reflectance import shade_with_derivatives
from fitter.vocabulary.choices import LightKind


@pytest.mark.parametrize("kind", list(LightKind))
def test_sums_are_those_of_the_points(kind):
    rng = np.random.default_rng(9)
    count = 60
    normals = rng.normal(size=(count, 3)) - [0.0, 0.0, 0.5]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    weights = rng.uniform(size=count)
    surface = LitSurface(
        positions=rng.normal(size=(count, 3)) * 0.3 + [0.0, 0.0, 3.0],
        normals=normals,
        observed=rng.uniform(0.0, 0.6, count),
        weights=weights / weights.sum(),
        albedo=rng.uniform(0.2, 0.6, count),
        specularity=rng.uniform(0.0, 0.3, count),
        ambient_limit=0.3,
        body_centre=np.array([0.1, 0.0, 3.0]),
        specular_exponent=12.0,
        eta=0.2,
    )
    light = Light(
        kind=kind,
        azimuth=0.4,
        elevation=0.3,
        distance=2.5 if kind is LightKind.POINT else float("inf"),
    )
    estimate = LightEstimate(
        light=light,
        ambient=0.05,
        albedo_scale=0.9,
        specularity_scale=1.3,
        energy=1.0,
    )
    derivatives = shade_with_derivatives(
        surface.positions,
        normals,
        light=light,
        body_centre=surface.body_centre,
        reflectance=Reflectance(
            albedo=0.9 * surface.albedo,
            specularity=1.3 * surface.specularity,
            ambient=estimate.ambient,
            specular_exponent=12.0,
        ),
    )
    residuals = derivatives.shading - surface.observed
    columns = light_columns(
        derivatives,
        light,
        albedo=surface.albedo,
        specularity=surface.specularity,
    )
    reweighted = (surface.weights * geman_mcclure_weights(residuals, surface.eta))[:, None]
    sums = LightSums(surface)
    energy = surface.weights @ geman_mcclure(residuals, surface.eta)
    assert sums.energy(estimate) == pytest.approx(energy, rel=1e-12)
    matrix, gradient = sums.normal_equations(estimate)
    np.testing.assert_allclose(matrix, columns.T @ (reweighted * columns), atol=1e-12)
    np.testing.assert_allclose(gradient, columns.T @ (reweighted[:, 0] * residuals), atol=1e-12)
