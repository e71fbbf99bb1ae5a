"""Kernels are compiled, or read as they were compiled, by one fit of the sample.

``python -m service.compute.kernels`` does it once an installation; a fork server does it before the
first fork, so that none of its children compiles what another has compiled.
"""

import io
import json
import logging
import os
from pathlib import Path
from typing import Final

from PIL import Image

from api_schemas.fit import FitRequest
from fitter.applications.caricature import caricature_of_most_unusual
from fitter.errors import ModelFileError
from fitter.fits.prepared_model import prepared_model
from fitter.person.fitted_person import FittedPerson
from service.compute import pipeline
from service.compute.files import with_result_document
from service.compute.pipeline_port import PipelineInput, PipelineOutput
from service.demo_data.sample import Sample, load_sample
from service.jobs.inputs import PERSON, SentPicture
from service.process.caches import KERNELS, forget_kernels, package, settle_folders
from service.submissions.submission import check_submission

LOG: Final = logging.getLogger(__name__)

SMALLER: Final = 4
"""Times, each side of the sample: a fit of this passes through the same code in half the time."""

MAX_PIXELS: Final = 1_000_000


def make_kernels_ready(detector: Path | None = None) -> None:
    """Fit the sample, with the packaged models: kernels are the same for all.

    Numba runs the files of its cache as it finds them, and ends over one that is damaged. So they
    are made anew where the sample cannot be fitted.

    Raises
    ------
    ModelFileError
        If a model is missing or damaged.
    """
    try:
        fit_sample(detector)
    except ModelFileError:
        raise
    except Exception as error:
        LOG.warning("Kernels are compiled anew, as those kept are of no use: %r", error)
        forget_kernels(Path(os.environ.get(KERNELS) or package()))
        fit_sample(detector)


def fit_sample(detector: Path | None = None) -> PipelineOutput:
    """Fit the sample in small.

    Fits are functions of their requests: nothing of the sample is left for them.
    """
    image, request = _smaller(load_sample())
    pictures = (SentPicture(image, None),)
    checked = check_submission(request, pictures, max_pixels=MAX_PIXELS)
    output = pipeline.run(
        PipelineInput(
            request=checked.request,
            pictures=pictures,
            max_pixels=MAX_PIXELS,
            detector=detector,
        ),
        lambda _: None,
    )
    with_result_document(output.result, output.files)
    return output


def _smaller(sample: Sample) -> tuple[bytes, FitRequest]:
    """The sample's picture and request, each side a fraction of what it was."""
    with Image.open(io.BytesIO(sample.image)) as picture:
        reduced = picture.reduce(SMALLER)
    encoded = io.BytesIO()
    reduced.save(encoded, "JPEG")
    request = json.loads(sample.request)
    for point in request["views"][0]["points"].values():
        point["x"] /= SMALLER
        point["y"] /= SMALLER
    return encoded.getvalue(), FitRequest.model_validate_json(json.dumps(request))


def _compile_all() -> None:
    """Compile what a fit calls, and what only a caricature does: where a surface crosses itself."""
    make_kernels_ready()
    person = FittedPerson.from_bytes(fit_sample().files[PERSON])
    operators = prepared_model(person.gender).operators
    caricature_of_most_unusual(operators.evaluator, person.body.shape, 1.1)


if __name__ == "__main__":
    print("Kernels are compiled, which takes one to three minutes where it has not been done yet.")
    settle_folders()
    _compile_all()
