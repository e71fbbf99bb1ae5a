"""A picture in the light of two lamps, from the request's words to the files of the result."""

import json

import numpy as np
import pytest

from api_schemas import results as wire
from api_schemas.requests import FitOptions
from fitter.export import artifacts
from fitter.fits.pipeline import fit
from fitter.fits.prepared_model import prepared_model
from fitter.person.fitted_person import FittedPerson
from fitter.result import FitResult
from fitter.vocabulary.choices import SurroundingsKind
from service.jobs.inputs import SentPicture
from service.worker import translate
from service.worker.fit_results import fit_result
from tests.evaluation.cases import CASES
from tests.evaluation.files import light_from_document, read_case
from tests.evaluation.light_figures import light_figures
from tests.evaluation.scoring import light_error
from tests.unit.export.glb_reader import read_glb

FILES = read_case(CASES["light_two_lamps"])


def fitted(kind: SurroundingsKind) -> FitResult:
    asked = FILES.request | {"light": {"surroundings": kind.value}}
    options = FitOptions.model_validate_json(json.dumps(asked))
    pictures = (SentPicture(FILES.image, None),)
    return fit(translate.fit_request(options, pictures, max_pixels=10_000_000))


@pytest.fixture(scope="module")
def uniform() -> FitResult:
    return fitted(SurroundingsKind.UNIFORM)


@pytest.fixture(scope="module")
def surrounded() -> FitResult:
    return fitted(SurroundingsKind.SPHERICAL_HARMONICS)


def test_surroundings_explain_more_of_the_picture(uniform, surrounded):
    before, after = light_figures(uniform), light_figures(surrounded)
    assert after.unexplained < before.unexplained
    assert after.skin_lit < before.skin_lit
    true = light_from_document(FILES.scene["light"])
    assert light_error(surrounded.person.light, true) < light_error(uniform.person.light, true)


def test_result_and_files_tell_the_surroundings(surrounded):
    assert surrounded.person.light is not None
    assert surrounded.person.reflectance is not None
    assert surrounded.person.reflectance.ambient == 0.0
    model = prepared_model(surrounded.person.gender).operators.model
    document = fit_result(surrounded, part_names=model.part_names)
    assert wire.FitResult.model_validate_json(document.model_dump_json()) == document
    assert document.light is not None
    assert document.light.surroundings is not None
    coefficients = np.array(document.light.surroundings.coefficients)
    np.testing.assert_allclose(coefficients, surrounded.person.light.surroundings, atol=1e-6)
    files = artifacts(surrounded, model=model, images=[FILES.image])
    lit = read_glb(files["body_posed.glb"]).attribute("_LIT")
    assert set(np.unique(lit)) == {0.0, 1.0}
    person = FittedPerson.from_bytes(surrounded.person.to_bytes())
    assert person.light is not None
    np.testing.assert_array_equal(person.light.surroundings, surrounded.person.light.surroundings)


def test_nobody_who_does_not_ask_gets_surroundings(uniform):
    assert uniform.person.light is not None
    assert uniform.person.light.surroundings is None
    document = fit_result(uniform, part_names=("part",) * len(uniform.person.body.pose))
    assert document.light is not None
    assert document.light.surroundings is None
