"""Focal length (section 3.1): from the caller, from EXIF, or assumed and reported as such."""

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from fitter.errors import InvalidInputError
from fitter.observation.picture_files import ExifTags
from fitter.render.camera import (
    ASSUMED_FOCAL_LENGTH_MM,
    FULL_FRAME_DIAGONAL_MM,
    focal_length_px_from_35mm,
)
from fitter.vocabulary.outcomes import FocalLengthSource
from fitter.vocabulary.remarks import Note, Remark, assumed

PLAUSIBLE_35MM = (5.0, 5000.0)
"""Range of real lenses in 35 mm equivalents: fisheyes start at 8, telescopes end at 3000."""


@runtime_checkable
class SaysLens(Protocol):
    """A request that may name a focal length: in pixels, or in 35 mm terms."""

    @property
    def focal_length_px(self) -> float | None:
        """Pixels of the upright original."""
        ...

    @property
    def focal_length_35mm(self) -> float | None:
        """The 35 mm equivalent, millimetres."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class FocalLength:
    """Pixels of the upright original, where they came from, and what had to be assumed."""

    pixels: float
    source: FocalLengthSource
    assumptions: tuple[Remark, ...] = ()


def focal_length(
    request: SaysLens, exif: ExifTags, *, width: int, height: int, stored_width: int
) -> FocalLength:
    """The best known focal length.

    The caller's value comes first: EXIF survives cropping and scaling, and is then misleading.
    Implausible EXIF values are ignored; implausible values from the caller are errors.

    Parameters
    ----------
    width, height
        Size of the upright picture.
    stored_width
        Width before the EXIF orientation was applied.

    Raises
    ------
    InvalidInputError
        ``focal-length-invalid`` or ``focal-length-twice``.
    """
    diagonal = math.hypot(width, height)
    if request.focal_length_px is not None and request.focal_length_35mm is not None:
        raise InvalidInputError(
            code="focal-length-twice",
            field="focal_length_px",
            reason="Both focal_length_px and focal_length_35mm are given.",
            remedy="Send one of them.",
        )
    if request.focal_length_px is not None:
        equivalent = request.focal_length_px / diagonal * FULL_FRAME_DIAGONAL_MM
        _check_plausible(equivalent, field="focal_length_px")
        return FocalLength(pixels=request.focal_length_px, source=FocalLengthSource.CALLER)
    if request.focal_length_35mm is not None:
        _check_plausible(request.focal_length_35mm, field="focal_length_35mm")
        return FocalLength(
            pixels=focal_length_px_from_35mm(request.focal_length_35mm, width=width, height=height),
            source=FocalLengthSource.CALLER,
        )
    if exif.focal_length_35mm is not None and _is_plausible(exif.focal_length_35mm):
        return FocalLength(
            pixels=focal_length_px_from_35mm(exif.focal_length_35mm, width=width, height=height),
            source=FocalLengthSource.EXIF_35MM,
        )
    from_sensor = _from_sensor(exif, stored_width=stored_width)
    if from_sensor is not None and _is_plausible(from_sensor / diagonal * FULL_FRAME_DIAGONAL_MM):
        return FocalLength(pixels=from_sensor, source=FocalLengthSource.EXIF_SENSOR)
    return FocalLength(
        pixels=focal_length_px_from_35mm(ASSUMED_FOCAL_LENGTH_MM, width=width, height=height),
        source=FocalLengthSource.ASSUMED,
        assumptions=(
            assumed(
                Note.LENS_ASSUMED,
                f"Neither the request nor the picture's EXIF data names a focal length; "
                f"{ASSUMED_FOCAL_LENGTH_MM:.0f} mm in 35 mm equivalent were taken.",
                where=("focal_length_35mm",),
            ),
        ),
    )


def _from_sensor(exif: ExifTags, *, stored_width: int) -> float | None:
    """Focal length by the sensor's pixel pitch, scaled if the picture was resized since."""
    if exif.focal_length_mm is None or exif.sensor_pixels_per_mm is None:
        return None
    resized = stored_width / (exif.pixel_x_dimension or stored_width)
    return exif.focal_length_mm * exif.sensor_pixels_per_mm * resized


def _is_plausible(equivalent_mm: float) -> bool:
    return PLAUSIBLE_35MM[0] <= equivalent_mm <= PLAUSIBLE_35MM[1]


def _check_plausible(equivalent_mm: float, *, field: str) -> None:
    if not _is_plausible(equivalent_mm):  # NaN compares false as well.
        low, high = PLAUSIBLE_35MM
        raise InvalidInputError(
            code="focal-length-invalid",
            field=field,
            reason=f"The focal length amounts to {equivalent_mm:g} mm in 35 mm terms.",
            remedy=f"Send one between {low:g} and {high:g} mm, or leave it out.",
        )
