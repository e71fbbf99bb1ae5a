"""A fit before the first one: what a process does once is done before it is forked."""

import io
import json
import logging
from pathlib import Path
from typing import Final

from PIL import Image

from fitter.errors import ModelFileError
from service.demo_data.sample import Sample, load_sample
from service.submissions.submission import check_submission
from service.worker import pipeline
from service.worker.artifacts import with_result_document
from service.worker.pipeline_port import PipelineInput

LOG: Final = logging.getLogger(__name__)

SMALLER: Final = 4
"""Times, each side of the sample: a fit of this passes through the same code in half the time."""

MAX_PIXELS: Final = 1_000_000


def rehearse(models: Path | None, detector: Path | None = None) -> None:
    """Fit the sample, and forget the result.

    A process that has fitted has its compiled kernels read from their cache and its libraries set
    up; a fork without takes 0.15 to 0.25 s of processor longer for its fit. Fits are functions of
    their requests: nothing of the sample is left for them.

    A sample that cannot be fitted, as with models trained on other people, is logged and no more.

    Raises
    ------
    ModelFileError
        If a model is missing or damaged.
    """
    try:
        image, request = _smaller(load_sample())
        checked = check_submission(request=request, image=image, mask=None, max_pixels=MAX_PIXELS)
        output = pipeline.run(
            PipelineInput(
                options=checked.options,
                image=image,
                mask=None,
                max_pixels=MAX_PIXELS,
                models=models,
                detector=detector,
            ),
            lambda _: None,
        )
        with_result_document(output.result, output.artifacts)
    except ModelFileError:
        raise
    except Exception as error:
        LOG.warning("The sample could not be fitted (%s): every fit takes longer.", error)


def _smaller(sample: Sample) -> tuple[bytes, bytes]:
    """The sample's picture and request, each side a fraction of what it was."""
    with Image.open(io.BytesIO(sample.image)) as picture:
        reduced = picture.reduce(SMALLER)
    encoded = io.BytesIO()
    reduced.save(encoded, "JPEG")
    request = json.loads(sample.request)
    for point in request["points"].values():
        point["x"] /= SMALLER
        point["y"] /= SMALLER
    return encoded.getvalue(), json.dumps(request).encode()
