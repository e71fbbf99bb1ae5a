"""From the caller's bytes to an upright 8-bit sRGB picture: limits first, then one decoding.

Accepted: JPEG, PNG, WebP and, where its decoder is installed, HEIC; grey, palette, RGB and CMYK; 8
bits, and 10 or 16 reduced to 8, because the noise of a photograph is above half a step of 8 bits.
Embedded colour profiles are honoured. Transparency is composited over white, as a browser shows it,
with a warning: we do not guess that the opaque part is the person; the caller can send it as the
mask.
"""

import io
import math
import warnings
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import UInt8
from PIL import Image as PillowImage
from PIL import ImageCms

from fitter.errors import InvalidInputError
from fitter.observation.picture_files import (
    FORMAT,
    ORIENTATION,
    WHOLE_PIXELS,
    ExifTags,
    is_heif,
    read_exif,
    ready_decoder,
)
from fitter.vocabulary.remarks import Note, Remark, remark

LEAST_SIDE_PX = 64
"""A person under 64 pixels leaves nothing to fit."""

LARGEST_ASPECT_RATIO = 20.0
"""A full-length portrait is at most 1:6; beyond 1:20 the working picture would be a thread."""

_SIGNATURES = {
    "JPEG": lambda data: data.startswith(b"\xff\xd8\xff"),
    "PNG": lambda data: data.startswith(b"\x89PNG\r\n\x1a\n"),
    "WEBP": lambda data: data[:4] == b"RIFF" and data[8:12] == b"WEBP",
    FORMAT: is_heif,
}

_REDUCIBLE = ("JPEG", "MPO")
"""Pillow's names of what can be decoded at a part of its size."""

_ACCEPTED = "Send a JPEG, PNG, WebP or HEIC picture."


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DecodedPicture:
    """An upright picture.

    Attributes
    ----------
    pixels
        (h, w, 3) sRGB, 8 bits, EXIF orientation applied.
    width, height
        Of the upright original, to whose pixels points and answers refer.
    stored_width
        Width before the orientation was applied: the direction EXIF's x refers to.
    exif
        The useful part of what the camera wrote.
    warnings
        What the caller should know about the conversion.
    reduction
        Pixels of the original to one of ``pixels``, in each direction; the last may be a part.
    """

    pixels: UInt8[np.ndarray, "h w 3"]
    width: int
    height: int
    stored_width: int
    exif: ExifTags
    warnings: tuple[Remark, ...]
    reduction: int = 1


def decode_picture(
    data: bytes, *, field: str, max_pixels: int, enough_pixels: float | None = None
) -> DecodedPicture:
    """Decode a picture.

    Parameters
    ----------
    data
        The encoded picture.
    field
        Name of the request field, for error messages.
    max_pixels
        Largest JPEG accepted, read from its header before anything is decoded; of other kinds no
        more than ``WHOLE_PIXELS`` are.
    enough_pixels
        A JPEG that keeps as many is decoded at a half, a quarter or an eighth of its size, from
        the low frequencies of its blocks: for pictures to look at, as their light is averaged less
        exactly. None decodes everything, up to ``WHOLE_PIXELS``.

    Raises
    ------
    InvalidInputError
        ``image-empty``, ``image-unsupported``, ``image-damaged``, ``image-too-large``,
        ``image-too-small``, ``image-too-narrow`` or ``image-animated`` (``mask-...`` in place of
        ``image-...`` where the field is the mask), or ``heic-not-installed``.
    """
    with _damage_named(field):
        picture = _opened(data, field=field, max_pixels=max_pixels)
        stored_width, stored_height = picture.size
        reduction = _reduction(picture, enough_pixels)
        if reduction > 1:
            picture.draft(None, (stored_width // reduction, stored_height // reduction))
        picture.load()
        exif = read_exif(picture)
        translucent = is_translucent(picture)
        pixels = np.asarray(as_srgb(_upright(picture, exif)))
    is_turned = exif.orientation in _SWAPPED
    remarks: list[Remark] = []
    if translucent:
        remarks.append(
            remark(
                Note.TRANSPARENCY_OVER_WHITE,
                "The picture is partly transparent and was laid over white.",
            )
        )
    if _has_other_shape(exif, stored_width, stored_height):
        remarks.append(
            remark(
                Note.OTHER_SHAPE,
                f"By its EXIF data the camera wrote {exif.pixel_x_dimension:.0f} x "
                f"{exif.pixel_y_dimension:.0f} pixels, and these are {stored_width} x "
                f"{stored_height}: another ratio.",
            )
        )
    return DecodedPicture(
        pixels=pixels,
        width=stored_height if is_turned else stored_width,
        height=stored_width if is_turned else stored_height,
        # A HEIC comes turned; cameras repeat in EXIF how the container has it turned.
        stored_width=stored_height if picture.info.get(ORIENTATION) in _SWAPPED else stored_width,
        exif=exif,
        warnings=tuple(remarks),
        reduction=reduction,
    )


def decode_coverage(data: bytes, *, field: str, max_pixels: int) -> UInt8[np.ndarray, "h w"]:
    """Decode a grey picture of the foreground, upright; transparent pixels are background.

    Raises
    ------
    InvalidInputError
        As :func:`decode_picture`.
    """
    with _damage_named(field):
        picture = _opened(data, field=field, max_pixels=min(max_pixels, WHOLE_PIXELS))
        picture.load()
        return np.asarray(as_grey(_upright(picture, read_exif(picture))))


OTHER_SHAPE: Final = 0.03
"""Difference of two ratios of width and height, of the ratio, that rounding does not explain."""


def _has_other_shape(exif: ExifTags, width: int, height: int) -> bool:
    """Whether the camera wrote a picture of another ratio, upright or turned."""
    if exif.pixel_x_dimension is None or exif.pixel_y_dimension is None:
        return False
    was, now = exif.pixel_x_dimension / exif.pixel_y_dimension, width / height
    return all(abs(math.log(now / each)) > OTHER_SHAPE for each in (was, 1.0 / was))


@contextmanager
def _damage_named(field: str) -> Iterator[None]:
    """Turn whatever a decoder makes of hostile bytes into one clear problem.

    Decoders may raise almost anything, hence the broad clause; and Pillow's warnings and its limit
    add nothing to the checks here, which have their own. Running out of memory does not count as
    damage.
    """
    with warnings.catch_warnings(), ExitStack() as stack:
        warnings.simplefilter("ignore")
        stack.callback(setattr, PillowImage, "MAX_IMAGE_PIXELS", PillowImage.MAX_IMAGE_PIXELS)
        PillowImage.MAX_IMAGE_PIXELS = None
        try:
            yield
        except (InvalidInputError, MemoryError):
            raise
        except Exception as error:
            raise InvalidInputError(
                code=f"{field}-damaged",
                field=field,
                reason="The file is truncated or damaged.",
                remedy="Send the whole file again, or save it anew from another program.",
            ) from error


def _opened(data: bytes, *, field: str, max_pixels: int) -> PillowImage.Image:
    """A picture that may be decoded, known by its header."""
    kind = _kind(data, field=field)
    if kind == FORMAT:
        ready_decoder(field)
    picture = PillowImage.open(io.BytesIO(data), formats=(kind,))
    most = max_pixels if picture.format in _REDUCIBLE else min(max_pixels, WHOLE_PIXELS)
    if picture.width * picture.height > most:
        raise _too_large(field, f"more than {most / 1e6:g} million pixels")
    _check_form(picture, field=field)
    return picture


def _reduction(picture: PillowImage.Image, enough_pixels: float | None) -> int:
    """Factor by which a decoder makes the picture smaller, in each direction."""
    if picture.format not in _REDUCIBLE:
        return 1
    pixels = picture.width * picture.height
    enough = WHOLE_PIXELS if enough_pixels is None else min(enough_pixels, WHOLE_PIXELS)
    needed = next((by for by in (1, 2, 4) if pixels <= by**2 * WHOLE_PIXELS), 8)
    wanted = next((by for by in (8, 4, 2) if pixels >= by**2 * enough), 1)
    return max(needed, wanted)


_TURNS = {
    2: PillowImage.Transpose.FLIP_LEFT_RIGHT,
    3: PillowImage.Transpose.ROTATE_180,
    4: PillowImage.Transpose.FLIP_TOP_BOTTOM,
    5: PillowImage.Transpose.TRANSPOSE,
    6: PillowImage.Transpose.ROTATE_270,
    7: PillowImage.Transpose.TRANSVERSE,
    8: PillowImage.Transpose.ROTATE_90,
}


_SWAPPED = range(5, 9)
"""Orientations that swap width and height."""


def _upright(picture: PillowImage.Image, exif: ExifTags) -> PillowImage.Image:
    # ImageOps.exif_transpose would also rewrite the EXIF block, and fail on a damaged one.
    return picture.transpose(_TURNS[exif.orientation]) if exif.orientation in _TURNS else picture


def _too_large(field: str, size: str) -> InvalidInputError:
    return InvalidInputError(
        code=f"{field}-too-large",
        field=field,
        reason=f"The picture has {size}.",
        remedy="Send a smaller version; two million pixels are plenty.",
    )


def _kind(data: bytes, *, field: str) -> str:
    if not data:
        raise InvalidInputError(
            code=f"{field}-empty", field=field, reason="The file has 0 bytes.", remedy=_ACCEPTED
        )
    for kind, matches in _SIGNATURES.items():
        if matches(data):
            return kind
    raise InvalidInputError(
        code=f"{field}-unsupported",
        field=field,
        reason="The file is no JPEG, PNG, WebP or HEIC picture.",
        remedy=_ACCEPTED,
    )


def _check_form(picture: PillowImage.Image, *, field: str) -> None:
    # Phones store a gain map or a second view as a further "frame" of a JPEG (MPO); its first
    # frame is the photograph, and any browser shows just that. A HEIC may hold a burst.
    if picture.format not in ("MPO", FORMAT) and getattr(picture, "is_animated", False):
        raise InvalidInputError(
            code=f"{field}-animated",
            field=field,
            reason="The picture is animated.",
            remedy="Send the one frame the points were clicked on.",
        )
    short, long = sorted(picture.size)
    if short < LEAST_SIDE_PX:
        raise InvalidInputError(
            code=f"{field}-too-small",
            field=field,
            reason=f"The picture measures {picture.width} x {picture.height} pixels.",
            remedy=f"Send a picture of at least {LEAST_SIDE_PX} pixels a side.",
        )
    if long > LARGEST_ASPECT_RATIO * short:
        raise InvalidInputError(
            code=f"{field}-too-narrow",
            field=field,
            reason=f"The picture measures {picture.width} x {picture.height} pixels.",
            remedy=f"Crop it to less than {LARGEST_ASPECT_RATIO:g} times as long as wide.",
        )


def is_translucent(picture: PillowImage.Image) -> bool:
    """Whether any pixel is less than opaque."""
    if not picture.has_transparency_data:
        return False
    lowest, _ = picture.convert("RGBA").getchannel("A").getextrema()
    return int(lowest) < 255  # pyright: ignore[reportArgumentType]


def as_srgb(picture: PillowImage.Image) -> PillowImage.Image:
    """8-bit sRGB without transparency, which is laid over white."""
    if picture.mode.startswith("I"):
        return _reduced_to_8_bits(picture).convert("RGB")
    profile = picture.info.get("icc_profile")
    if is_translucent(picture):
        layered = picture.convert("RGBA")
        white = PillowImage.new("RGBA", layered.size, "white")
        picture = PillowImage.alpha_composite(white, layered).convert("RGB")
    elif picture.mode != "CMYK":
        picture = _as_rgb(picture)
    converted = _converted_by_profile(picture, profile) if profile else None
    return converted or _as_rgb(picture)


def as_grey(picture: PillowImage.Image) -> PillowImage.Image:
    """8-bit grey without transparency, which is laid over black."""
    if picture.mode.startswith("I"):
        return _reduced_to_8_bits(picture)
    if picture.has_transparency_data:
        layered = picture.convert("RGBA")
        black = PillowImage.new("RGBA", layered.size, "black")
        picture = PillowImage.alpha_composite(black, layered)
    return picture.convert("L")


def _as_rgb(picture: PillowImage.Image) -> PillowImage.Image:
    # Pillow would copy what is red, green and blue already.
    return picture if picture.mode == "RGB" else picture.convert("RGB")


def _converted_by_profile(
    picture: PillowImage.Image, profile_data: bytes
) -> PillowImage.Image | None:
    """The picture in sRGB, None where it is sRGB already or the profile cannot be used."""
    try:
        profile = ImageCms.ImageCmsProfile(io.BytesIO(profile_data))
        if "sRGB" in ImageCms.getProfileDescription(profile):
            return None
        return ImageCms.profileToProfile(
            picture, profile, ImageCms.createProfile("sRGB"), outputMode="RGB"
        )
    except (ImageCms.PyCMSError, OSError, ValueError):
        # A grey profile on a picture stored as RGB, or a broken one: browsers ignore these too.
        return None


def _reduced_to_8_bits(picture: PillowImage.Image) -> PillowImage.Image:
    values = np.asarray(picture).astype(np.int64)
    return PillowImage.fromarray((np.clip(values, 0, 65535) // 257).astype(np.uint8))
