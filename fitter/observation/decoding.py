"""From the caller's bytes to an upright 8-bit sRGB picture: limits first, then one decoding.

Accepted: JPEG, PNG and WebP; grey, palette, RGB and CMYK; 8 bits, and 16 reduced to 8, because
the noise of a photograph is above half a step of 8 bits. Embedded colour profiles are honoured.
Transparency is laid over white, as a browser shows it on its page, with a warning: guessing that
the opaque part is the person is not ours to do, the caller can post it as the mask.
"""

import io
import warnings
from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt8
from PIL import Image as PillowImage
from PIL import ImageCms, ImageOps

from fitter.errors import InvalidInputError
from fitter.observation.exif import ExifTags, read_exif
from fitter.remarks import FitWarning

LEAST_SIDE_PX = 64
"""A person under 64 pixels leaves nothing to fit."""

LARGEST_ASPECT_RATIO = 20.0
"""A full-length portrait is at most 1:6; beyond 1:20 the working picture would be a thread."""

_SIGNATURES = {
    "JPEG": lambda data: data.startswith(b"\xff\xd8\xff"),
    "PNG": lambda data: data.startswith(b"\x89PNG\r\n\x1a\n"),
    "WEBP": lambda data: data[:4] == b"RIFF" and data[8:12] == b"WEBP",
}

_ACCEPTED = "Send a JPEG, PNG or WebP picture."


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DecodedPicture:
    """An upright picture.

    Attributes
    ----------
    pixels
        (h, w, 3) sRGB, 8 bits, EXIF orientation applied.
    stored_width
        Width before the orientation was applied: the direction EXIF's x refers to.
    exif
        What the camera wrote, as far as it is of use.
    warnings
        What the caller should know of the conversion.
    """

    pixels: UInt8[np.ndarray, "h w 3"]
    stored_width: int
    exif: ExifTags
    warnings: tuple[FitWarning, ...]


def decode_picture(data: bytes, *, field: str, max_pixels: int) -> DecodedPicture:
    """Decode a picture.

    Parameters
    ----------
    data
        The encoded picture.
    field
        Name of the request field, for error messages.
    max_pixels
        Largest picture accepted, read from its header before anything is decoded.

    Raises
    ------
    InvalidInputError
        ``image-empty``, ``image-unsupported``, ``image-damaged``, ``image-too-large``,
        ``image-too-small``, ``image-too-narrow`` or ``image-animated`` (``mask-...`` in place of
        ``image-...`` where the field is the mask).
    """
    picture, exif = _load(data, field=field, max_pixels=max_pixels)
    stored_width = picture.width
    remarks: list[FitWarning] = []
    if exif.orientation != 1:
        picture = ImageOps.exif_transpose(picture)
    if _is_translucent(picture):
        remarks.append(
            FitWarning(
                code="transparency-over-white",
                message=(
                    "The picture is partly transparent and was laid over white. If its opaque "
                    "part is the person, post that as the mask."
                ),
            )
        )
    return DecodedPicture(
        pixels=np.asarray(_as_srgb(picture)),
        stored_width=stored_width,
        exif=exif,
        warnings=tuple(remarks),
    )


def decode_coverage(data: bytes, *, field: str, max_pixels: int) -> UInt8[np.ndarray, "h w"]:
    """Decode a grey picture of the foreground, upright; transparent pixels are background.

    Raises
    ------
    InvalidInputError
        As :func:`decode_picture`.
    """
    picture, exif = _load(data, field=field, max_pixels=max_pixels)
    if exif.orientation != 1:
        picture = ImageOps.exif_transpose(picture)
    if picture.mode.startswith("I"):
        return _reduced_to_8_bits(picture)
    if picture.has_transparency_data:
        layered = picture.convert("RGBA")
        black = PillowImage.new("RGBA", layered.size, "black")
        picture = PillowImage.alpha_composite(black, layered)
    return np.asarray(picture.convert("L"))


def _load(data: bytes, *, field: str, max_pixels: int) -> tuple[PillowImage.Image, ExifTags]:
    kind = _kind(data, field=field)
    too_large = InvalidInputError(
        code=f"{field}-too-large",
        field=field,
        reason=f"The picture has more than {max_pixels / 1e6:g} million pixels.",
        remedy="Send a smaller version; two million pixels are plenty.",
    )
    try:
        with warnings.catch_warnings():
            # Our own limit is below or beside Pillow's; its warning would say nothing more.
            warnings.simplefilter("ignore")
            picture = PillowImage.open(io.BytesIO(data), formats=(kind,))
    except PillowImage.DecompressionBombError as error:
        raise too_large from error
    except Exception as error:  # Hostile bytes make decoders raise nearly anything.
        raise _damaged(field, kind) from error
    if picture.width * picture.height > max_pixels:
        raise too_large
    _check_form(picture, field=field)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            picture.load()
            exif = read_exif(picture)
    except Exception as error:  # As above.
        raise _damaged(field, kind) from error
    return picture, exif


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
        reason="The file is no JPEG, PNG or WebP picture.",
        remedy=_ACCEPTED,
    )


def _damaged(field: str, kind: str) -> InvalidInputError:
    name = "WebP" if kind == "WEBP" else kind
    return InvalidInputError(
        code=f"{field}-damaged",
        field=field,
        reason=f"The {name} file is truncated or damaged.",
        remedy="Send the whole file again, or save the picture anew from another program.",
    )


def _check_form(picture: PillowImage.Image, *, field: str) -> None:
    # Phones store a gain map or a second view as a further "frame" of a JPEG (MPO); its first
    # frame is the photograph, and any browser shows just that.
    if picture.format != "MPO" and getattr(picture, "is_animated", False):
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


def _is_translucent(picture: PillowImage.Image) -> bool:
    if not picture.has_transparency_data:
        return False
    lowest, _ = picture.convert("RGBA").getchannel("A").getextrema()
    return int(lowest) < 255  # pyright: ignore[reportArgumentType]


def _as_srgb(picture: PillowImage.Image) -> PillowImage.Image:
    if picture.mode.startswith("I"):
        return PillowImage.fromarray(_reduced_to_8_bits(picture)).convert("RGB")
    profile = picture.info.get("icc_profile")
    if _is_translucent(picture):
        layered = picture.convert("RGBA")
        white = PillowImage.new("RGBA", layered.size, "white")
        picture = PillowImage.alpha_composite(white, layered).convert("RGB")
    elif picture.mode != "CMYK":
        picture = picture.convert("RGB")
    converted = _converted_by_profile(picture, profile) if profile else None
    return converted or picture.convert("RGB")


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


def _reduced_to_8_bits(picture: PillowImage.Image) -> UInt8[np.ndarray, "h w"]:
    values = np.asarray(picture).astype(np.int64)
    return (np.clip(values, 0, 65535) // 257).astype(np.uint8)
