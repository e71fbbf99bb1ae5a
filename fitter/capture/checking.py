"""All checks of a picture, and what they say together."""

from collections.abc import Callable
from dataclasses import dataclass

from fitter.capture.capture import Capture, box_of
from fitter.capture.clothes import clothes
from fitter.capture.framing import (
    camera_distance_m,
    distance,
    lean_deg,
    picture_size,
    roll,
    size,
    wholeness,
)
from fitter.capture.people import face, nobody_else, proportions, somebody
from fitter.capture.picture_quality import brightness, darkness, sharpness
from fitter.capture.posture import announced_view, arms, facing, posture, seen_from
from fitter.vocabulary.outcomes import SeenFrom
from fitter.vocabulary.remarks import Box, Code, Remark, Severity

Check = Callable[[Capture], Remark | None]

CHECKS_OF_PICTURE: tuple[Check, ...] = (
    somebody,
    nobody_else,
    picture_size,
    darkness,
    brightness,
    sharpness,
)
CHECKS_OF_PERSON: tuple[Check, ...] = (
    wholeness,
    size,
    announced_view,
    face,
    arms,
    clothes,
    posture,
    proportions,
    roll,
    distance,
)
"""Made where somebody was found."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Checked:
    """Findings of all checks of a picture.

    Attributes
    ----------
    findings
        What blocks first, then in the order of the checks.
    unchecked
        What could not be checked, and why.
    box
        The person who is meant, pixels of the upright original; None without a detector or where
        nobody was found.
    seen
        From where they are seen; None if not known.
    lean_deg
        How far they lean to the right of the picture, degrees, if they stand upright.
    distance_m
        From the camera to them, if focal length and stature are known.
    """

    findings: tuple[Remark, ...]
    unchecked: tuple[Remark, ...]
    box: Box | None
    seen: SeenFrom | None
    lean_deg: float | None
    distance_m: float | None

    @property
    def usable(self) -> bool:
        """Whether nothing blocks."""
        return all(each.severity is not Severity.BLOCKS for each in self.findings)


def check_capture(capture: Capture) -> Checked:
    """Make every check that can be made."""
    remarks = _remarks(capture)
    findings = [each for each in remarks if each.is_finding]
    cosine = facing(capture) if capture.shows_somebody else None
    return Checked(
        findings=tuple(sorted(findings, key=lambda each: each.severity is not Severity.BLOCKS)),
        unchecked=tuple(each for each in remarks if not each.is_finding),
        box=None if capture.body is None else capture.in_original(box_of(capture.body)),
        seen=None if cosine is None else seen_from(cosine),
        lean_deg=lean_deg(capture) if capture.shows_somebody else None,
        distance_m=camera_distance_m(capture) if capture.shows_somebody else None,
    )


def _remarks(capture: Capture) -> list[Remark]:
    made = [remark for check in CHECKS_OF_PICTURE if (remark := check(capture)) is not None]
    if capture.shows_somebody:
        blurred = any(each.code is Code.BLURRED and each.is_finding for each in made)
        # A face that is not found in a blurred picture need not be hidden.
        checks = [check for check in CHECKS_OF_PERSON if not (blurred and check is face)]
        return made + [remark for check in checks if (remark := check(capture)) is not None]
    return made
