"""Whether one person is in the picture: neither nobody nor several."""

from fitter.capture.capture import Capture, box_of
from fitter.capture.finding import Code, Finding, Remark, Unchecked
from fitter.vocabulary.outcomes import Severity

NO_DETECTOR = "No detector looked at the picture."


def somebody(capture: Capture) -> Remark | None:
    """Whether the person who is meant was found."""
    if capture.bodies is None:
        return Unchecked(code=Code.NOBODY_FOUND, reason=NO_DETECTOR)
    if capture.body is not None:
        return None
    if not capture.bodies:
        reason = "Nobody was found in the picture who can be measured."
    else:
        reason = f"{len(capture.bodies)} people were found, but nobody where the points lie."
    return Finding(
        code=Code.NOBODY_FOUND,
        severity=Severity.BLOCKS,
        reason=reason,
        remedy="Have the whole person in the picture, upright, in good light and unhidden.",
    )


def nobody_else(capture: Capture) -> Remark | None:
    """Whether others are in the picture, and nobody says who is meant."""
    if capture.bodies is None:
        return Unchecked(code=Code.SEVERAL_PEOPLE, reason=NO_DETECTOR)
    others = [each for each in capture.bodies if each is not capture.body]
    if capture.body is None or not others or capture.is_chosen:
        return None
    return Finding(
        code=Code.SEVERAL_PEOPLE,
        severity=Severity.HARMS,
        reason=(
            f"{len(capture.bodies)} people were found; the largest is taken, and the box is that "
            "of the next."
        ),
        remedy="Have nobody else in the picture, or say by `person` or a point who is meant.",
        box=capture.in_original(box_of(others[0])),
    )
