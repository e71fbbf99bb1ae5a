import io

import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.request import Click
from fitter.vocabulary.choices import Cues, Gender
from tests.evaluation.again import COMPARED, Again, Asked, again_lines, again_summary, variants
from tests.evaluation.photograph import EXIF_DIRECTORY, FOCAL_LENGTH_IN_35MM_FILM
from tests.one_picture import one_picture


def photograph() -> bytes:
    shown = np.random.default_rng(1).integers(0, 256, (200, 100, 3), dtype=np.uint8)
    exif = PillowImage.Exif()
    exif.get_ifd(EXIF_DIRECTORY)[FOCAL_LENGTH_IN_35MM_FILM] = 28
    stream = io.BytesIO()
    PillowImage.fromarray(shown).save(stream, "JPEG", quality=95, exif=exif)
    return stream.getvalue()


def test_a_picture_has_nine_variants_whose_points_stay_where_they_are_on_the_person():
    request = one_picture(
        image=photograph(),
        clicks={"nose": Click(x=50.0, y=60.0)},
        gender=Gender.FEMALE,
        focal_length_px=300.0,
    )
    of_picture = variants(request)
    assert len(of_picture) == 9
    assert len({each.views[0].image for each in of_picture}) == 9
    views = [each.views[0] for each in of_picture]
    sizes = [PillowImage.open(io.BytesIO(view.image)).size for view in views]
    assert sizes == [(100, 200)] * 4 + [(98, 198), (96, 196), (94, 194), (99, 198), (100, 200)]
    # From the middle, in units of the focal length: where the ray through the point goes.
    rays = [
        ((view.clicks["nose"].x - width / 2) / view.focal_length_px)
        for view, (width, _) in zip(views, sizes, strict=True)
        if view.focal_length_px is not None
    ]
    np.testing.assert_allclose(rays, [rays[0]] * 9, atol=1e-12)


@pytest.mark.parametrize("number", range(9))
def test_variants_keep_what_the_file_says_of_the_camera(number: int):
    request = one_picture(image=photograph(), clicks={}, gender=Gender.MALE)
    with PillowImage.open(io.BytesIO(variants(request)[number].views[0].image)) as picture:
        assert picture.getexif().get_ifd(EXIF_DIRECTORY)[FOCAL_LENGTH_IN_35MM_FILM] == 28


def test_spreads_stand_beside_the_stated_errors():
    k = len(COMPARED)
    found = [
        Again(
            asked=Asked(picture="photo_00", proposed=True),
            cues=cues,
            values=np.outer([-spread, 0.0, spread], np.ones(k)) + 90.0,
            standard_errors=np.full(k, 2.0),
        )
        for cues, spread in ((Cues.SE, 0.5), (Cues.SES, 1.0))
    ]
    assert [line.split()[3:] for line in again_lines(found)] == [
        ["0.50/2.0=0.25"] * k,
        ["1.00/2.0=0.50"] * k,
    ]
    _, se, ses, *_ = again_summary(found)
    assert se.split() == ["real", "proposed", "SE", "1", *["0.50", "0.25"] * k]
    assert ses.split() == ["real", "proposed", "SES", "1", *["1.00", "0.50"] * k]
