import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image as PillowImage

from fitter.errors import InvalidInputError
from fitter.observation.pixels import (
    WORKING_PIXELS,
    WorkingSize,
    display_from_linear,
    linear_from_display,
    linear_working_picture,
    luminance_of,
    working_coverage,
    working_size,
)
from fitter.observation.subject import check_height
from fitter.request import Click, LightGuess
from fitter.vocabulary.outcomes import FocalLengthSource
from tests.unit.observation.pictures import (
    HEIGHT,
    WIDTH,
    encode,
    noise,
    read,
    smooth,
    standing_clicks,
    view,
)

PICTURE = encode(PillowImage.fromarray(noise()))


def problem_of(**changes: object) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        read(view(PICTURE, **changes))
    return caught.value


def test_srgb_decoding_undoes_encoding():
    values = np.linspace(0, 1, 1001)
    np.testing.assert_allclose(linear_from_display(display_from_linear(values)), values, atol=1e-12)
    assert linear_from_display(np.array(0.5)) == pytest.approx(0.21404, abs=1e-5)


def test_luminance_of_white_is_one():
    np.testing.assert_allclose(luminance_of(np.ones((2, 3, 3), dtype=np.float32)), 1, rtol=1e-6)


def test_a_small_picture_is_taken_as_it_is():
    observation = read(view(PICTURE))
    assert observation.scale == 1.0
    assert observation.camera == observation.image_camera
    np.testing.assert_allclose(observation.display, noise() / 255, atol=1e-6)
    np.testing.assert_allclose(
        observation.luminance, luminance_of(observation.linear_rgb), rtol=1e-6
    )
    assert dict(observation.clicks) == standing_clicks()
    assert observation.focal_length_source is FocalLengthSource.ASSUMED
    assert [each.code for each in observation.assumptions] == ["lens-assumed"]
    assert observation.mask is None
    assert observation.warnings == ()


@given(width=st.integers(64, 9000), height=st.integers(64, 9000))
def test_the_working_size_keeps_to_its_limit_and_never_enlarges(width: int, height: int):
    size = working_size(width=width, height=height)
    assert size.width * size.height <= WORKING_PIXELS
    assert size.scale <= 1.0
    assert 0 <= width * size.scale - size.width < 1
    assert 0 <= height * size.scale - size.height < 1


@pytest.mark.parametrize("factor", [2, 3])
def test_whole_factors_average_whole_blocks_of_light(factor: int):
    pixels = noise()[: HEIGHT // 6 * 6, : WIDTH // 6 * 6]
    size = WorkingSize(
        width=pixels.shape[1] // factor, height=pixels.shape[0] // factor, scale=1 / factor
    )
    blocks = linear_from_display(pixels / 255).reshape(size.height, factor, size.width, factor, 3)
    np.testing.assert_allclose(
        linear_working_picture(pixels, size), blocks.mean(axis=(1, 3)), atol=1e-6
    )


def overlaps(pixels: int, size: int, factor: float) -> np.ndarray:
    """(size, pixels) share of each pixel in each of the spans of ``factor`` pixels."""
    starts, each = np.arange(size)[:, None] * factor, np.arange(pixels)[None, :]
    return np.clip(np.minimum(starts + factor, each + 1) - np.maximum(starts, each), 0.0, None)


@pytest.mark.parametrize("factor", [1.0, 1.25, 1.618, 2.7386, 7.3])
def test_averages_are_sums_by_area(factor: float):
    pixels = noise()
    size = WorkingSize(width=int(WIDTH / factor), height=int(HEIGHT / factor), scale=1 / factor)
    across, down = overlaps(WIDTH, size.width, factor), overlaps(HEIGHT, size.height, factor)
    light = np.einsum(
        "iy,jx,yxc->ijc", down, across, linear_from_display(pixels / 255), optimize=True
    )
    np.testing.assert_allclose(linear_working_picture(pixels, size), light / factor**2, atol=1e-6)
    coverage = pixels[:, :, 0].copy()
    shares = down @ (coverage / 255) @ across.T
    np.testing.assert_allclose(working_coverage(coverage, size), shares / factor**2, atol=1e-6)


def test_any_factor_keeps_the_mean_light_of_the_area_it_covers():
    ramp = np.repeat(np.arange(200, dtype=np.uint8)[None, :], 150, axis=0)[:, :, None]
    size = WorkingSize(width=123, height=92, scale=0.617)
    averaged = working_coverage(ramp[:, :, 0], size)
    # The mean of the step function floor(x) over [j, j + 1) / scale, integrated exactly.
    edges = np.arange(124) / 0.617
    whole = np.floor(edges)
    integral = whole * (whole - 1) / 2 + whole * (edges - whole)
    expected = np.diff(integral) * 0.617 / 255
    np.testing.assert_allclose(averaged, np.broadcast_to(expected, averaged.shape), atol=1e-6)


def test_a_large_picture_is_scaled_with_its_camera_and_points():
    clicks = {
        name: type(click)(x=click.x * 10, y=click.y * 10, occluded=name == "nose")
        for name, click in standing_clicks().items()
    }
    pixels = np.zeros((1600, 1200, 3), dtype=np.uint8)
    # A white square whose centre is a point to find again.
    pixels[900:940, 500:540] = 255
    observation = read(
        view(encode(PillowImage.fromarray(pixels)), clicks=clicks, focal_length_px=1500.0)
    )
    height, width = observation.luminance.shape
    assert height * width <= WORKING_PIXELS
    scale = observation.scale
    rows, columns = np.mgrid[:height, :width] + 0.5
    weight = observation.luminance / observation.luminance.sum()
    centre = [(weight * columns).sum(), (weight * rows).sum()]
    # Partly covered border pixels count at their centres: a few thousandths of a pixel.
    np.testing.assert_allclose(centre, [520 * scale, 920 * scale], atol=0.01)
    np.testing.assert_allclose(
        observation.camera.rays(np.array(centre)),
        observation.image_camera.rays(np.array([520.0, 920.0])),
        atol=1e-5,
    )
    assert observation.clicks["left_hip"].x == pytest.approx(700 * scale)
    assert observation.clicks["nose"].occluded
    assert not observation.clicks["left_hip"].occluded
    assert observation.image_camera.focal_length_px == 1500
    assert observation.assumptions == ()


def test_a_mask_is_averaged_and_thresholded_at_half():
    pixels = np.zeros((1600, 1200), dtype=np.uint8)
    pixels[400:1200, 300:900] = 255
    clicks = {
        name: type(click)(x=click.x * 10, y=click.y * 10)
        for name, click in standing_clicks().items()
    }
    picture = encode(PillowImage.new("RGB", (1200, 1600)))
    observation = read(view(picture, clicks=clicks, mask=encode(PillowImage.fromarray(pixels))))
    assert observation.mask is not None
    assert observation.mask.shape == observation.luminance.shape
    assert observation.mask.mean() == pytest.approx(0.25, rel=0.01)


@pytest.mark.parametrize(
    ("mask", "code"),
    [
        (np.full((HEIGHT + 1, WIDTH), 255, np.uint8), "mask-size"),
        (np.full((WIDTH, HEIGHT), 255, np.uint8), "mask-size"),
        (np.zeros((HEIGHT, WIDTH), np.uint8), "mask-without-foreground"),
        (np.full((HEIGHT, WIDTH), 127, np.uint8), "mask-without-foreground"),
        (np.full((HEIGHT, WIDTH), 255, np.uint8), "mask-without-background"),
    ],
)
def test_an_unusable_mask_is_refused(mask: np.ndarray, code: str):
    problem = problem_of(mask=encode(PillowImage.fromarray(mask)))
    assert (problem.code, problem.field) == (code, "mask")


@pytest.mark.parametrize("height_m", [1.19, 2.31, 0.0, -1.7, 170.0, float("nan")])
def test_an_impossible_height_is_refused(height_m: float):
    with pytest.raises(InvalidInputError) as caught:
        check_height(height_m)
    assert (caught.value.code, caught.value.field) == ("out-of-range", "height_m")


@pytest.mark.parametrize(
    "light", [LightGuess(azimuth=float("nan")), LightGuess(distance=0.0), LightGuess(distance=-1.0)]
)
def test_an_impossible_light_is_refused(light: LightGuess):
    assert problem_of(light=light).code == "light-invalid"


def test_warnings_of_all_parts_come_together():
    clicks = standing_clicks()
    clicks["left_hip"], clicks["right_hip"] = clicks["right_hip"], clicks["left_hip"]
    translucent = np.dstack([noise(), np.full((HEIGHT, WIDTH), 128, dtype=np.uint8)])
    observation = read(view(encode(PillowImage.fromarray(translucent)), clicks=clicks))
    assert [warning.code for warning in observation.warnings] == [
        "transparency-over-white",
        "shoulders-and-hips-disagree",
    ]


def test_of_a_picture_that_is_decoded_at_a_part_of_its_size_points_and_camera_are_the_originals(
    monkeypatch,
):
    large = PillowImage.fromarray(smooth()).resize((10 * WIDTH, 10 * HEIGHT))
    clicks = {name: Click(x=10 * at.x, y=10 * at.y) for name, at in standing_clicks().items()}
    sent = view(encode(large, "JPEG", quality=95), clicks=clicks)
    whole = read(sent)
    monkeypatch.setattr("fitter.observation.decoding.WHOLE_PIXELS", 2 * WORKING_PIXELS)
    part = read(sent)
    assert part.image_camera == whole.image_camera
    assert (part.scale, part.camera) == (whole.scale, whole.camera)
    assert dict(part.clicks) == dict(whole.clicks)
    np.testing.assert_allclose(part.display, whole.display, atol=0.01)
