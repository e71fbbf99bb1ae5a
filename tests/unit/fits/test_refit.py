"""A fitted picture once more, from its body and with a prior on the shape."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.priors import POPULATION_PRECISION, ShapePrior, population_prior
from fitter.fits.pipeline import fit
from fitter.fits.prepared_model import prepared_model
from fitter.fits.refit import refit
from fitter.render.rasterizer import render
from fitter.request import Cues, FitRequest
from fitter.result import FitResult, Outcome, PictureFit
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
) -> PictureFit:
    return refit(
        request,
        prepared_model(request.gender),
        result.person.body,
        prior=prior or population_prior(len(result.person.body.shape)),
        hold_shape=hold_shape,
        report=ignore,
    )


def apart_mm(one: PictureFit, other: PictureFit) -> float:
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
    triangles = prepared_model(asked.gender).operators.model.triangles
    mask = render(result.found.posed_vertices, triangles, result.person.camera).silhouette
    told = replace(asked, mask=encoded_mask(mask))
    first = fit(told)
    again = once_more(told, first)
    assert again.outcome is Outcome.CONVERGED
    assert apart_mm(again, first.found) < 1.5
    assert np.abs(again.person.body.shape - first.person.body.shape).max() < 0.1


@pytest.mark.parametrize("cues", ["outlined", "shaded"])
def test_a_fit_stays_near_its_own_minimum(cues, request):
    asked, result = request.getfixturevalue(cues)
    again = once_more(asked, result)
    assert apart_mm(again, result.found) < 6.0
    assert again.silhouette_overlap > result.found.silhouette_overlap - 0.01
    assert (again.person.gender, again.height_m) == (result.person.gender, result.found.height_m)
    assert again.person.camera == result.person.camera
    assert (again.person.light is None) == (result.person.light is None)
    assert again.person.body.shape[0] == result.person.body.shape[0]
    spread = np.sqrt(np.diag(again.person.shape_covariance)[1:])
    assert (spread > 0.0).all()
    assert (spread < POPULATION_PRECISION**-0.5).all()


def test_what_other_pictures_say_draws_the_shape(outlined):
    asked, result = outlined
    n = len(result.person.body.shape)
    mean = result.person.body.shape + np.append(0.0, np.full(n - 1, 0.3))
    sure = ShapePrior(mean=mean, precision=1e4 * population_prior(n).precision)
    drawn = once_more(asked, result, prior=sure)
    np.testing.assert_allclose(drawn.person.body.shape[1:], mean[1:], atol=0.05)
    told = POPULATION_PRECISION**-0.5 / 100.0
    assert np.sqrt(np.diag(drawn.person.shape_covariance)).max() < 1.1 * told


def test_a_shape_that_is_held_stays_as_it_is_and_pose_and_light_settle(shaded):
    asked, result = shaded
    body = result.person.body
    other = body.shape + np.append(0.0, np.full(len(body.shape) - 1, 0.1))
    person = replace(result.person, body=replace(body, shape=other))
    begun = replace(result, found=replace(result.found, person=person))
    held = once_more(asked, begun, hold_shape=True)
    np.testing.assert_array_equal(held.person.body.shape, other)
    assert not held.person.shape_covariance.any()
    assert not np.array_equal(held.person.body.pose, result.person.body.pose)
    assert held.silhouette_overlap > 0.9
    assert held.person.light is not None
    assert held.person.reflectance is not None
    assert len(held.person.albedo_rgb) == len(result.person.albedo_rgb)
