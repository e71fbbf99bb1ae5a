"""Remarks: what is wrong with a picture, what to look at, what was assumed, what was not checked.

All are of one type. What each means to whoever took the picture stands in one catalogue here, by
its code: what to do about it. Why it is said, with the figures, says who found it.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

Box = tuple[float, float, float, float]
"""Left, top, right and bottom, pixels of the picture as a browser shows it."""


class Severity(StrEnum):
    """Severity of a remark.

    Findings: ``blocks``, the picture is to be taken again; ``harms``, measurements are worse.
    Others: ``warns``, to be looked at; ``assumed``, for want of a word from the caller;
    ``unchecked``, a check that could not be made.
    """

    BLOCKS = "blocks"
    HARMS = "harms"
    WARNS = "warns"
    ASSUMED = "assumed"
    UNCHECKED = "unchecked"


class Code(StrEnum):
    """Codes of what may be found in a picture.

    By a fit alone: ``COVERED``, that something is before or beside the person, ``SQUEEZED``, that
    the picture is, and ``CONTRADICTED``, that no person was measured.
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
    COVERED = "covered"
    FACE_HIDDEN = "face-hidden"
    NOT_STANDING = "not-standing"
    CHILD = "child"
    BLURRED = "blurred"
    TOO_DARK = "too-dark"
    TOO_BRIGHT = "too-bright"
    CAMERA_ROLLED = "camera-rolled"
    CAMERA_TOO_NEAR = "camera-too-near"
    SQUEEZED = "squeezed"
    CONTRADICTED = "contradicted"


class Note(StrEnum):
    """Codes of warnings and assumptions."""

    TRANSPARENCY_OVER_WHITE = "transparency-over-white"
    OTHER_SHAPE = "other-shape"
    SHOULDERS_AND_HIPS_DISAGREE = "shoulders-and-hips-disagree"
    SIDES_SWAPPED = "left-and-right-may-be-swapped"
    BODY_OUTSIDE_PICTURE = "body-outside-picture"
    SEGMENTATION_DOUBTFUL = "segmentation-doubtful"
    UNUSUAL_HEIGHT = "unusual-height"
    CLOTHES_NOT_LOOSE = "clothes-not-loose"
    LOW_OVERLAP = "low-silhouette-overlap"
    AMBIGUOUS_FACING = "ambiguous-limb-facing"
    IMPLAUSIBLE = "implausible"
    NO_PERSON = "no-person"
    GIVEN_CONTRADICTED = "given-contradicted"
    DIFFERENT_PEOPLE = "different-people"
    SHADING_NOT_USED = "shading-not-used"
    MEASUREMENTS_WITHHELD = "measurements-withheld"
    SEEN_FROM_BEHIND = "seen-from-behind"
    LIMBS_CROSSED = "limbs-crossed"
    UP_UNCERTAIN = "up-uncertain"
    BVH_IRREGULAR = "bvh-irregular"
    CLIP_CUT = "clip-cut"
    WAY_DIFFERS = "way-differs"
    HEIGHT_ASSUMED = "height-assumed"
    LENS_ASSUMED = "lens-assumed"
    POINTS_PROPOSED = "points-proposed"


_SIDES: Final = "Left and right are the person's own: see whether they are swapped."
_WITHOUT_FORCE: Final = "Do what the findings say, or leave out `force`."

REMEDIES: Final[Mapping[Code | Note, str]] = {
    Code.NOBODY_FOUND: "Have the whole person in the picture, upright, in good light and unhidden.",
    Code.SEVERAL_PEOPLE: (
        "Have nobody else in the picture, or say who is meant: by `person` or a point, and by all "
        "points where people overlap."
    ),
    Code.CUT_OFF: (
        "Show the person from head to foot, and from the shoulders to below the hips at least: "
        "step back or turn the camera until there is room on all sides."
    ),
    Code.PERSON_TOO_SMALL: (
        "Go nearer or zoom in until the person fills the picture, or crop it to them."
    ),
    Code.PICTURE_TOO_SMALL: (
        "Send the picture as the camera took it, not a preview or a thumbnail."
    ),
    Code.OTHER_VIEW: (
        "Have the person turn as the view says. Check the view too, whether left and right are the "
        "person's own, and whether the picture is mirrored."
    ),
    Code.ARMS_AGAINST_TRUNK: (
        "Have the arms held away from the body, by a hand's breadth at the hips or more."
    ),
    Code.CLOTHES_LOOSE: "Have close-fitting clothes worn, or send the weight with the fit.",
    Code.SKIN_NOT_FOUND: (
        "Send a picture in colour with the face in sight, or say how the clothes fit."
    ),
    Code.COVERED: "Have nothing and nobody before the person or beside them.",
    Code.FACE_HIDDEN: "Send the picture with the face in sight.",
    Code.NOT_STANDING: (
        "Have the person stand upright, with straight legs, if they can. Of who cannot, a body is "
        "made of measurements taken with a tape; a picture gives the pose, by points put by hand, "
        "and rough measurements if these are insisted on."
    ),
    Code.CHILD: "Measure grown-up people alone; if this is one, let the face be seen clearly.",
    Code.BLURRED: "Let the camera focus on the person, hold it still, and use more light.",
    Code.TOO_DARK: "Switch on more light, from the camera's side and not from behind the person.",
    Code.TOO_BRIGHT: (
        "Expose less: touch the person on the camera's screen, or leave the glaring light."
    ),
    Code.CAMERA_ROLLED: "Hold the camera level and have the person stand upright.",
    Code.CAMERA_TOO_NEAR: (
        "Step back to 2.5 m or more and zoom in; if the picture was cropped, send the focal length "
        "in its own pixels."
    ),
    Code.SQUEEZED: "Send the picture as the camera took it, in its own ratio.",
    Code.CONTRADICTED: (
        "See whether the points are on the right joints of one person, and whether a mask that was "
        "sent shows this person alone; or send another picture. What is held before the body is to "
        "be put aside. If it is the body's own, take a tape: pictures cannot tell the measurements "
        "of a body so far from those that were learned."
    ),
    Note.TRANSPARENCY_OVER_WHITE: "If its opaque part is the person, post that as the mask.",
    Note.OTHER_SHAPE: (
        "A squeezed picture gives wrong girths: send it as it was taken. If it was cropped, send "
        "the focal length in its own pixels."
    ),
    Note.SHOULDERS_AND_HIPS_DISAGREE: _SIDES,
    Note.SIDES_SWAPPED: _SIDES,
    Note.BODY_OUTSIDE_PICTURE: "Show the whole person where what is outside counts.",
    Note.SEGMENTATION_DOUBTFUL: "Send a mask, or take the picture before another background.",
    Note.UNUSUAL_HEIGHT: "Check height and gender.",
    Note.CLOTHES_NOT_LOOSE: "If nothing loose hides the body, say that clothing is tight.",
    Note.LOW_OVERLAP: "Check the points and left and right, or send a mask.",
    Note.AMBIGUOUS_FACING: "Say which in limb_facing.",
    Note.IMPLAUSIBLE: _WITHOUT_FORCE,
    Note.NO_PERSON: _WITHOUT_FORCE,
    Note.GIVEN_CONTRADICTED: "Check this value and the height, and their units.",
    Note.DIFFERENT_PEOPLE: "Check that view and its points, and left and right in it.",
    Note.SHADING_NOT_USED: "Nothing is lost where the girths alone count.",
    Note.MEASUREMENTS_WITHHELD: (
        "Send the weight if it was not sent: it narrows girths most. Else do what the findings "
        "say; `force` gives them as they are."
    ),
    Note.SEEN_FROM_BEHIND: _SIDES,
    Note.LIMBS_CROSSED: _SIDES,
    Note.UP_UNCERTAIN: "If that is wrong, as for a person who lies, send `up`.",
    Note.BVH_IRREGULAR: "Look at the motion, and write the file anew if it is wrong.",
    Note.CLIP_CUT: "Ask for a later stretch to see the rest.",
    Note.WAY_DIFFERS: "See whether the file's own feet slide, or its hips stay on the spot.",
    Note.HEIGHT_ASSUMED: "Send `height_m` if it is known.",
    Note.LENS_ASSUMED: "Send `focal_length_35mm`, or the picture as the camera wrote it.",
    Note.POINTS_PROPOSED: "Look at them, and send those that are wrong.",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Remark:
    """Something to know of a picture, a person or a fit.

    ``code`` is stable. ``reason`` has the figure that was measured or taken, ``remedy`` says what
    to do. ``where`` names the points or the fields of a request that it is about.
    """

    code: str
    severity: Severity
    reason: str
    remedy: str
    where: tuple[str, ...]

    @property
    def text(self) -> str:
        """The reason and what to do."""
        return f"{self.reason} {self.remedy}"

    @property
    def is_finding(self) -> bool:
        """Whether it is something wrong with a picture."""
        return self.severity in (Severity.BLOCKS, Severity.HARMS)


def remark(
    code: Code | Note,
    reason: str,
    *,
    severity: Severity = Severity.WARNS,
    where: Iterable[str] = (),
) -> Remark:
    """A remark with the remedy of its code."""
    return Remark(
        code=code,
        severity=severity,
        reason=reason,
        remedy=REMEDIES[code],
        where=tuple(where),
    )


def assumed(code: Note, reason: str, *, where: Iterable[str]) -> Remark:
    """A remark of what was taken for want of a word from the caller."""
    return remark(code, reason, severity=Severity.ASSUMED, where=where)


def unchecked(code: Code, reason: str) -> Remark:
    """A remark of a check that could not be made."""
    return remark(code, reason, severity=Severity.UNCHECKED)
