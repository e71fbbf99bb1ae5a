"""Files that may come along with a request for a product, as parts of its form."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from api_schemas.problems import FieldProblem, problem
from api_schemas.products import AnyProductOptions
from api_schemas.products.bodies import LEAST_OWN_TEXTURE, TEXTURE_SIZES, AnimationOptions
from api_schemas.products.documents import (
    MAX_CHART_BYTES,
    NOT_A_CHART,
    ChartError,
    SizeOptions,
    ease_faults,
    read_chart,
)
from fitter.applications.bvh import MAX_BYTES
from fitter.applications.motion_file import read_motion
from fitter.errors import InvalidInputError
from service.jobs.inputs import CHART, CLIP, TEXTURE
from service.submissions.image_header import ReadHeader
from service.submissions.refusal import RefusedError, refused
from service.submissions.submission import check_picture


@dataclass(frozen=True, slots=True, kw_only=True)
class FormPart:
    """A file that may come along with a request, as a part of its form.

    ``check`` is given the file, what is asked for, the most pixels a picture may have, and what
    reads its header. It returns the file's media type; of what cannot be used it raises
    :class:`service.submissions.refusal.RefusedError`.
    """

    description: str
    media_types: str
    check: Callable[..., str]


def _check_motion(clip: bytes, options: AnyProductOptions, **_of_pictures: object) -> str:
    """Read a BVH file: what cannot be made of it is refused now, in the same words."""
    if len(clip) > MAX_BYTES:
        raise RefusedError(
            problem(
                "payload-too-large",
                field=CLIP,
                detail=f"The motion has {len(clip)} bytes, more than {MAX_BYTES}.",
                remedy="Cut the clip, or lower its frame rate.",
            )
        )
    if isinstance(options, AnimationOptions):
        try:
            read_motion(clip, named=options.joints, start_s=options.start_s)
        except InvalidInputError as error:
            raise refused(
                FieldProblem(
                    field=error.field, code=error.code, reason=error.reason, remedy=error.remedy
                )
            ) from error
    return "text/plain"


_BVH: Final = FormPart(
    description=(
        "A motion as a BVH file. Joints are known by the names of many programs, such as CMU, "
        "Mixamo, Biovision, SMPL or Unreal; `joints` names them otherwise. Its rest pose does not "
        "matter."
    ),
    media_types="text/plain, application/octet-stream",
    check=_check_motion,
)


def _check_texture(
    texture: bytes, options: AnyProductOptions, *, max_pixels: int, read: ReadHeader
) -> str:
    """Check a painted atlas by its header alone; returns its media type."""
    del options
    header = check_picture(TEXTURE, texture, max_pixels=max_pixels, read=read)
    largest = TEXTURE_SIZES[-1]
    reason = None
    if header.width != header.height:
        reason = "is not square, as the atlas is"
    elif not LEAST_OWN_TEXTURE <= header.width <= largest:
        reason = f"is not between {LEAST_OWN_TEXTURE} and {largest} texels a side"
    if reason is not None:
        raise refused(
            FieldProblem(
                field=TEXTURE,
                code="texture-size",
                reason=f"The texture, {header.width} x {header.height}, {reason}.",
                remedy=f"Paint on atlas.png of any texture of this fit, or scale to {largest} x "
                f"{largest}.",
            )
        )
    return header.media_type


_ATLAS: Final = FormPart(
    description=(
        "A painted atlas, square, in the layout of `atlas.png` of any texture of the fit: JPEG, "
        "PNG or WebP, for colours `own`."
    ),
    media_types="image/jpeg, image/png, image/webp, image/heic",
    check=_check_texture,
)


def _check_chart(chart: bytes, options: AnyProductOptions, **_of_pictures: object) -> str:
    """Read the chart; returns its media type."""
    if len(chart) > MAX_CHART_BYTES:
        raise RefusedError(
            problem(
                "payload-too-large",
                field=CHART,
                detail=f"The chart has {len(chart)} bytes, more than {MAX_CHART_BYTES}.",
                remedy="Send the sizes of one garment alone.",
            )
        )
    try:
        read = read_chart(chart)
    except ChartError as error:
        raise refused(
            FieldProblem(field=CHART, code=NOT_A_CHART, reason=str(error), remedy=error.remedy)
        ) from error
    assert isinstance(options, SizeOptions)
    faults = ease_faults(options, read)
    if faults:
        raise refused(*faults)
    return "text/csv"


_TABLE: Final = FormPart(
    description=(
        "A size chart as CSV: a header `size,chest_girth,waist_girth_navel` with the names of "
        "measurements, then a row for each size, `M,94-98,80-84`, in centimetres."
    ),
    media_types="text/csv, text/plain, application/octet-stream",
    check=_check_chart,
)

FORM_PARTS: Final[Mapping[str, FormPart]] = {CLIP: _BVH, TEXTURE: _ATLAS, CHART: _TABLE}
"""All that may come along with a request, by name."""
