"""Pictures of the suite at other sizes show the same person to the same camera."""

import io

import pytest
from PIL import Image as PillowImage

from fitter.vocabulary.choices import Cues
from fitter.vocabulary.outcomes import FocalLengthSource
from tests.benchmarks.requests import resized
from tests.evaluation.cases import CASES
from tests.evaluation.files import read_case
from tests.evaluation.scene import FocalLength
from tests.evaluation.suite import fit_request
from tests.unit.observation.pictures import read

SOURCES = {
    FocalLength.GIVEN: FocalLengthSource.CALLER,
    FocalLength.EXIF: FocalLengthSource.EXIF_35MM,
    FocalLength.MISSING: FocalLengthSource.ASSUMED,
}


def sent(focal_length):
    case = next(case for case in CASES.values() if case.focal_length is focal_length)
    return fit_request(read_case(case), Cues.SE)


@pytest.mark.parametrize("focal_length", list(FocalLength))
def test_clicks_and_focal_length_grow_with_the_picture(focal_length):
    request = sent(focal_length)
    (view,) = request.views
    with PillowImage.open(io.BytesIO(view.image)) as picture:
        width, height = picture.size
    (larger,) = resized(request, width=2 * width, height=2 * height).views
    before, after = read(view), read(larger)
    assert (after.image_camera.width, after.image_camera.height) == (2 * width, 2 * height)
    assert after.focal_length_source is before.focal_length_source is SOURCES[focal_length]
    assert after.image_camera.focal_length_px == pytest.approx(
        2 * before.image_camera.focal_length_px, rel=1e-6
    )
    for name, click in view.clicks.items():
        moved = larger.clicks[name]
        assert (moved.x, moved.y) == pytest.approx((2 * click.x, 2 * click.y))
        assert moved.occluded is click.occluded
