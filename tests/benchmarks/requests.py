"""The evaluation suite's pictures at the sizes that are timed."""

import io

from PIL import Image as PillowImage

from fitter.fits.pipeline import fit
from fitter.request import Click, FitRequest
from fitter.vocabulary.choices import Cues
from tests.accuracy.cases import CASES
from tests.accuracy.files import read_case
from tests.accuracy.true_picture import fit_request
from tests.one_picture import changed

_WARMING = 2
"""Fits before the clock starts: compiled code is loaded and memory is kept."""

_QUALITY = 90


def suite_requests(
    count: int, *, width: int, height: int, cues: Cues = Cues.SES
) -> list[FitRequest]:
    """The first ``count`` pictures of the suite, each at this size; past its end it begins anew."""
    cases = list(CASES.values())
    return [
        resized(fit_request(read_case(cases[index % len(cases)]), cues), width=width, height=height)
        for index in range(count)
    ]


def resized(request: FitRequest, *, width: int, height: int) -> FitRequest:
    """The same request for the picture at another size of the same shape."""
    (view,) = request.views
    with PillowImage.open(io.BytesIO(view.image)) as picture:
        factor = width / picture.width
        exif = picture.info.get("exif", b"")
        same_shape = picture.resize((width, height), PillowImage.Resampling.LANCZOS)
    stream = io.BytesIO()
    same_shape.save(stream, "JPEG", quality=_QUALITY, exif=exif)
    focal = view.focal_length_px
    return changed(
        request,
        image=stream.getvalue(),
        clicks={
            name: Click(x=factor * click.x, y=factor * click.y, occluded=click.occluded)
            for name, click in view.clicks.items()
        },
        focal_length_px=None if focal is None else factor * focal,
    )


def warm_up() -> None:
    """Fit a few pictures untimed."""
    for request in suite_requests(_WARMING, width=480, height=640):
        fit(request)
