"""What a request for a derivation says, and the file that comes along with it."""

import codecs
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from fastapi import Request
from starlette.concurrency import run_in_threadpool

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivation_kinds.animation import AnimationOptions
from api_schemas.derivation_kinds.texture import (
    LEAST_OWN_TEXTURE,
    TEXTURE_SIZES,
    TextureColours,
    TextureOptions,
)
from api_schemas.derivations import DerivationRequest
from api_schemas.problems import FieldProblem, problem
from service.api.job_inputs import File
from service.api.json_bodies import JSON, media_type, read_json_text, unsupported
from service.api.problems import ProblemError
from service.api.uploads import MULTIPART, read_request_and_files
from service.jobs.inputs import CLIP, TEXTURE
from service.submissions.refusal import refused
from service.submissions.submission import check_picture
from service.submissions.validation import parsed

MAX_CLIP_BYTES: Final = 32 * 1024 * 1024
"""What the fitter reads at most; a minute of motion capture is a tenth of it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sent:
    """The request as JSON text, and the files that came along, by the names of their parts."""

    text: bytes
    files: Mapping[str, File]


async def read_derivation(
    request: Request, *, max_pixels: int
) -> tuple[AnyDerivationOptions, Sent]:
    """Read the request: JSON, or a form with it and a motion or a texture.

    Raises
    ------
    RefusedError, ProblemError
        If it is neither, or says or brings what cannot be.
    """
    if media_type(request) == JSON:
        text, parts = await read_json_text(request), {}
        asked = parsed(DerivationRequest, text, whole="body", called="the body").root
    elif media_type(request) == MULTIPART:
        text, parts = await read_request_and_files(request, tuple(_CHECKS))
        asked = parsed(DerivationRequest, text, whole="request", called="the part 'request'").root
    else:
        raise unsupported(
            request,
            remedy=f"Send {JSON}, or {MULTIPART} with the parts 'request' and '{CLIP}' or "
            f"'{TEXTURE}'.",
            accepted=f"{JSON}, {MULTIPART}",
        )
    _refuse_wrong_parts(asked, parts)
    return asked, Sent(text=text, files=await run_in_threadpool(_checked, parts, max_pixels))


def brings_texture(options: AnyDerivationOptions) -> bool:
    """Whether a texture of the caller's own is to be laid on the body."""
    return isinstance(options, TextureOptions) and options.colours is TextureColours.OWN


def _checked(parts: Mapping[str, bytes], max_pixels: int) -> dict[str, File]:
    return {
        name: File(content=content, media_type=_CHECKS[name](content, max_pixels))
        for name, content in parts.items()
    }


def _refuse_wrong_parts(asked: AnyDerivationOptions, parts: Mapping[str, bytes]) -> None:
    if brings_texture(asked) and TEXTURE not in parts:
        raise refused(
            FieldProblem(
                field=TEXTURE,
                code="missing",
                reason=f"The part '{TEXTURE}' is missing, which these colours are read from.",
                remedy=f"Send {MULTIPART} with the parts 'request' and '{TEXTURE}'.",
            )
        )
    taken = CLIP if isinstance(asked, AnimationOptions) else None
    taken = TEXTURE if brings_texture(asked) else taken
    for name in parts:
        if name != taken:
            raise refused(
                FieldProblem(
                    field=name,
                    code="unknown-field",
                    reason=f"This request for a derivation of kind {asked.kind} takes no part "
                    f"'{name}'.",
                    remedy=_REMEDIES[name],
                )
            )


_REMEDIES: Final[Mapping[str, str]] = {
    CLIP: "Send the request alone, as JSON, or ask for an animation.",
    TEXTURE: "Send the request alone, as JSON, or ask for a texture with colours 'own'.",
}


def _check_clip(clip: bytes, max_pixels: int) -> str:
    """Check what can be told of a BVH file without reading it."""
    del max_pixels
    if len(clip) > MAX_CLIP_BYTES:
        raise ProblemError(
            problem(
                "payload-too-large",
                field=CLIP,
                detail=f"The motion has {len(clip)} bytes, more than {MAX_CLIP_BYTES}.",
                remedy="Cut the clip, or lower its frame rate.",
            )
        )
    if not clip.removeprefix(codecs.BOM_UTF8).lstrip()[:9].upper() == b"HIERARCHY":
        raise refused(
            FieldProblem(
                field=CLIP,
                code="not-a-bvh",
                reason="The motion does not begin with HIERARCHY: it is no BVH file.",
                remedy="Export the motion as BVH.",
            )
        )
    return "text/plain"


def _check_texture(texture: bytes, max_pixels: int) -> str:
    """Check a painted atlas by its header alone; returns its media type."""
    header = check_picture(TEXTURE, texture, max_pixels=max_pixels)
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


_CHECKS: Final[Mapping[str, Callable[[bytes, int], str]]] = {
    CLIP: _check_clip,
    TEXTURE: _check_texture,
}
"""By the part's name: what checks a file's bytes and pixels, and returns its media type."""
