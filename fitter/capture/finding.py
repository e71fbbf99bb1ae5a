"""Findings of checks, and what they could not look at."""

from dataclasses import dataclass
from enum import StrEnum

from fitter.vocabulary.outcomes import Severity

Box = tuple[float, float, float, float]
"""Left, top, right and bottom, pixels of the upright original."""


class Code(StrEnum):
    """Codes of what may be found.

    By a fit alone: ``COVERED``, that something is before or beside the person, and
    ``CONTRADICTED``, that no person was measured. Where proposals of points warn of the same,
    they use the same code.
    """

    NOBODY_FOUND = "nobody-found"
    SEVERAL_PEOPLE = "several-people"
    CUT_OFF = "cut-off"
    PERSON_TOO_SMALL = "person-too-small"
    PICTURE_TOO_SMALL = "picture-too-small"
    OTHER_VIEW = "other-view"
    ARMS_AGAINST_TRUNK = "arms-against-trunk"
    CLOTHES_LOOSE = "clothes-loose"
    SKIN_NOT_FOUND = "skin-not-found"
    FACE_HIDDEN = "face-hidden"
    COVERED = "covered"
    NOT_STANDING = "not-standing"
    CHILD = "child"
    BLURRED = "blurred"
    TOO_DARK = "too-dark"
    TOO_BRIGHT = "too-bright"
    CAMERA_ROLLED = "camera-rolled"
    CAMERA_TOO_NEAR = "camera-too-near"
    CONTRADICTED = "contradicted"


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Something that is wrong with a picture.

    Attributes
    ----------
    code
        Stable.
    severity
        What it means for measurements.
    reason
        What was measured, in a sentence with the figure.
    remedy
        What to do about it, in a sentence.
    points
        Names of the points it is about.
    box
        Where in the picture it is, if at one place.
    """

    code: Code
    severity: Severity
    reason: str
    remedy: str
    points: tuple[str, ...] = ()
    box: Box | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Unchecked:
    """A check that was not made, and a sentence that says why."""

    code: Code
    reason: str


Remark = Finding | Unchecked
