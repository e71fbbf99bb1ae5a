"""What is said of one picture, in the pixels of another."""

import io
from dataclasses import dataclass

from PIL import Image

from api_schemas.checks import CaptureCheck
from api_schemas.proposals import PictureSize, PointsProposal
from service.submissions.image_header import read_image_header

Box = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Scale:
    """From a picture to one of another size, each way by itself."""

    size: PictureSize
    across: float
    down: float

    def proposal(self, found: PointsProposal) -> PointsProposal:
        """Points and people; the mask is not in it yet."""
        points = {
            name: point.model_copy(
                update={
                    "x": round(point.x * self.across, 2),
                    "y": round(point.y * self.down, 2),
                    "expected_error_px": round(
                        point.expected_error_px * max(self.across, self.down), 2
                    ),
                }
            )
            for name, point in found.points.items()
        }
        persons = tuple(
            each.model_copy(update={"box": self._box(each.box)}) for each in found.persons
        )
        return found.model_copy(
            update={"image_size": self.size, "points": points, "persons": persons}
        )

    def check(self, found: CaptureCheck) -> CaptureCheck:
        """The person's place, and that of what is wrong."""
        findings = tuple(
            each if each.box is None else each.model_copy(update={"box": self._box(each.box)})
            for each in found.findings
        )
        box = None if found.box is None else self._box(found.box)
        return found.model_copy(update={"image_size": self.size, "box": box, "findings": findings})

    def grey_png(self, encoded: bytes) -> bytes:
        """A mask."""
        with Image.open(io.BytesIO(encoded)) as mask:
            resized = mask.resize((self.size.width, self.size.height))
        written = io.BytesIO()
        resized.save(written, "PNG", compress_level=1)
        return written.getvalue()

    def _box(self, box: Box) -> Box:
        left, top, right, bottom = box
        return (
            round(left * self.across, 2),
            round(top * self.down, 2),
            round(right * self.across, 2),
            round(bottom * self.down, 2),
        )


def scale_between(known: bytes, other: bytes) -> Scale:
    """The scale from one encoded picture to another, both as a browser shows them."""
    source, target = read_image_header(known), read_image_header(other)
    return Scale(
        size=PictureSize(width=target.width, height=target.height),
        across=target.width / source.width,
        down=target.height / source.height,
    )
