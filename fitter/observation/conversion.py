"""From any way of storing a picture to 8-bit sRGB or grey."""

import io

import numpy as np
from PIL import Image as PillowImage
from PIL import ImageCms


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
