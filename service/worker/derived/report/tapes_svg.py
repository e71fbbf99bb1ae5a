"""The tapes on the body as vector drawings within HTML."""

import base64
from html import escape

from fitter.arrays import Points2D
from service.worker.derived.report.pictures import TapePicture
from service.worker.derived.report.tape_drawing import TAG_PX, Tag
from service.worker.derived.report.wording import PictureWords


def tapes_svg(panels: tuple[TapePicture, ...], words: PictureWords) -> str:
    """All sides in a row and in one scale; nothing where there are none."""
    if not panels:
        return ""
    figures = "".join(map(_figure, panels))
    return (
        f'<section class="tapes"><h2>{escape(words.tapes)}</h2>'
        f"<p>{escape(words.tapes_note)}</p><div>{figures}</div></section>"
    )


def _figure(panel: TapePicture) -> str:
    picture = panel.picture
    encoded = base64.b64encode(picture.content).decode()
    caption = escape(picture.caption)
    return (
        f'<figure style="flex: {picture.width} 1 0">'
        f'<svg viewBox="0 0 {picture.width} {picture.height}" role="img" aria-label="{caption}">'
        f'<image href="data:{picture.media_type};base64,{encoded}" width="{picture.width}" '
        f'height="{picture.height}"/>'
        f'<path class="other" d="{_path(panel.others)}"/><path d="{_path(panel.lines)}"/>'
        f"{''.join(map(_tag, panel.tags))}</svg><figcaption>{caption}</figcaption></figure>"
    )


def _path(lines: tuple[Points2D, ...]) -> str:
    """Each line begins anew; a tenth of a pixel is a tenth of a millimetre of the body."""
    return "".join("M" + " ".join(f"{x:.1f},{y:.1f}" for x, y in line.tolist()) for line in lines)


def _tag(tag: Tag) -> str:
    return (
        f'<circle cx="{tag.x:.1f}" cy="{tag.y:.1f}" r="{TAG_PX:.0f}"/>'
        f'<text x="{tag.x:.1f}" y="{tag.y:.1f}" dy="9">{tag.number}</text>'
    )
