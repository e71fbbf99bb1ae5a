"""A fitted picture once more, from its body and with a prior on the shape."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.priors import ShapePrior, population_prior
from fitter.fittable import packaged_body
from fitter.pipeline import fit
from fitter.refit import refit
from fitter.render.rasterizer import render
from fitter.request import Cues, FitRequest
from fitter.result import FitResult, LitBody, Outcome
from tests.benchmarks.requests import resized
from tests.evaluation.cases import CASES
from tests.evaluation.files import encoded_mask, read_case
from tests.evaluation.suite import fit_request

MILLIMETRES = 1000.0


def ignore(_):
    return None


def asked_for(cues: Cues) -> FitRequest:
    files = read_case(CASES["woman_young_heavy_standing"])
    return resized(fit_request(files, cues), width=300, height=400)


def once_more(
    request: FitRequest,
    result: FitResult,
    *,
    prior: ShapePrior | None = None,
    hold_shape: bool = False,
) -> LitBody:
    return refit(
        request,
        packaged_body(request.gender),
        result.body,
        prior=prior or population_prior(len(result.body.shape)),
        hold_shape=hold_shape,
        report=ignore,
    )


def apart_mm(one: LitBody, other: LitBody) -> float:
    """Mean distance of vertices once the bodies' centres are together: depth is hardly seen."""
    apart = one.posed_vertices - other.posed_vertices
    return MILLIMETRES * float(np.linalg.norm(apart - apart.mean(axis=0), axis=1).mean())


@pytest.fixture(scope="module")
def outlined() -> tuple[FitRequest, FitResult]:
    asked = asked_for(Cues.SE)
    return asked, fit(asked)


@pytest.fixture(scope="module")
def shaded() -> tuple[FitRequest, FitResult]:
    asked = asked_for(Cues.SES)
    return asked, fit(asked)


def test_a_fit_by_its_own_mask_stays_where_it_ended(outlined):
    asked, result = outlined
    # Nothing is cut or laid out anew with a mask: the energy is the same but for its scales' depth.
    triangles = packaged_body(asked.gender).instruments.model.triangles
    mask = render(result.posed_vertices, triangles, result.image_camera).silhouette
    told = replace(asked, mask=encoded_mask(mask))
    first = fit(told)
    again = once_more(told, first)
    assert again.outcome is Outcome.CONVERGED
    assert apart_mm(again, first) < 1.5
    assert np.abs(again.body.shape - first.body.shape).max() < 0.1


@pytest.mark.parametrize("cues", ["outlined", "shaded"])
def test_a_fit_stays_near_its_own_minimum(cues, request):
    asked, result = request.getfixturevalue(cues)
    again = once_more(asked, result)
    assert apart_mm(again, result) < 6.0
    assert again.silhouette_overlap > result.silhouette_overlap - 0.01
    assert (again.gender, again.height_m) == (result.gender, result.height_m)
    assert again.image_camera == result.image_camera
    assert (again.light is None) == (result.light is None)
    assert again.body.shape[0] == result.body.shape[0]
    spread = np.sqrt(np.diag(again.shape_covariance)[1:])
    assert (spread > 0.0).all()
    assert (spread < 1.0).all()


def test_what_other_pictures_say_draws_the_shape(outlined):
    asked, result = outlined
    n = len(result.body.shape)
    mean = result.body.shape + np.append(0.0, np.full(n - 1, 0.3))
    sure = ShapePrior(mean=mean, precision=1e4 * population_prior(n).precision)
    drawn = once_more(asked, result, prior=sure)
    np.testing.assert_allclose(drawn.body.shape[1:], mean[1:], atol=0.05)
    assert np.sqrt(np.diag(drawn.shape_covariance)).max() < 0.011


def test_a_shape_that_is_held_stays_as_it_is_and_pose_and_light_settle(shaded):
    asked, result = shaded
    other = result.body.shape + np.append(0.0, np.full(len(result.body.shape) - 1, 0.1))
    begun = replace(result, body=replace(result.body, shape=other))
    held = once_more(asked, begun, hold_shape=True)
    np.testing.assert_array_equal(held.body.shape, other)
    assert not held.shape_covariance.any()
    assert not np.array_equal(held.body.pose, result.body.pose)
    assert held.silhouette_overlap > 0.9
    assert held.light is not None
    assert held.reflectance is not None
    assert len(held.albedo_rgb) == len(result.albedo_rgb)
