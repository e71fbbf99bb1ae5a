"""What a process does once is done before it is forked: kernels are read, or a sample is fitted."""

import io
import json
import logging
from contextlib import suppress
from pathlib import Path
from typing import Final

from PIL import Image

from fitter.detection.detector import installed_detector
from fitter.errors import DetectorUnavailableError, ModelFileError
from service.demo_data.sample import Sample, load_sample
from service.jobs.inputs import SentPicture
from service.submissions.submission import check_fit
from service.worker import pipeline
from service.worker.artifacts import with_result_document
from service.worker.kernel_cache import keep_kernels, make_kernels_ready, restore_kernels
from service.worker.pipeline_port import PipelineInput

LOG: Final = logging.getLogger(__name__)

SMALLER: Final = 4
"""Times, each side of the sample: a fit of this passes through the same code in half the time."""

MAX_PIXELS: Final = 1_000_000


def make_ready(models: Path | None, detector: Path | None = None) -> None:
    """Have everything in memory that fits need beside the models.

    A second of processor where the kernels are compiled; else the sample is fitted, which compiles
    them.

    Raises
    ------
    ModelFileError
        If a model is missing or damaged.
    """
    # Without one, whoever needs it is told.
    with suppress(DetectorUnavailableError):
        installed_detector(detector)
    # With the packaged models, whose sample can be fitted: kernels are the same for all models.
    make_kernels_ready(lambda: rehearse(None, detector))


def rehearse(models: Path | None, detector: Path | None = None) -> bool:
    """Fit the sample, and forget the result; say whether it could be fitted.

    A process that has fitted has its kernels compiled. Fits are functions of their requests:
    nothing of the sample is left for them.

    A sample that cannot be fitted, as with models trained on other people, is logged and no more.

    Raises
    ------
    ModelFileError
        If a model is missing or damaged.
    """
    try:
        image, request = _smaller(load_sample())
        checked = check_fit(request=request, image=image, mask=None, max_pixels=MAX_PIXELS)
        output = pipeline.run(
            PipelineInput(
                options=checked.options,
                pictures=(SentPicture(image, None),),
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
        return False
    return True


def rehearse_sandbox(models: Path | None, detector: Path | None = None) -> None:
    """Make the canned results of a sandbox, and once what it derives from them at once.

    A fault is logged and no more: jobs come to the same and fail.

    Raises
    ------
    ModelFileError
        If a model is missing or damaged.
    """
    # Imported here: no other worker needs what derives.
    from service.worker.sandbox import derive_all

    kept = restore_kernels()
    try:
        derive_all(models, detector)
        if kept is None or not kept.is_complete():
            keep_kernels(kept, rehearsed=True)
    except ModelFileError:
        raise
    except Exception:
        LOG.exception("The results of the sandbox could not be made.")


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
