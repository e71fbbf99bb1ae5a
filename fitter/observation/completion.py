"""Points that nobody clicked, proposed by the detector."""

from collections.abc import Mapping
from dataclasses import replace

from fitter.detection.detector import DetectedBody
from fitter.errors import InvalidInputError
from fitter.remarks import Assumption
from fitter.request import Click


def completed_clicks(
    clicks: Mapping[str, Click], detected: DetectedBody | None
) -> dict[str, Click]:
    """The clicks, and proposals for the missing points; all in pixels of the same picture.

    Raises
    ------
    InvalidInputError
        ``person-not-found`` if nobody was detected where the clicks are.
    """
    if detected is None:
        where = "in the picture" if not clicks else "where the points lie"
        raise InvalidInputError(
            code="person-not-found",
            field="points",
            reason=f"No person was found {where}, so that no points can be proposed.",
            remedy="Click the points, or send a picture that shows the whole person.",
        )
    return {**detected.points, **clicks}


def proposal_assumptions(
    clicks: Mapping[str, Click], completed: Mapping[str, Click]
) -> tuple[Assumption, ...]:
    """Report that points were proposed, and which."""
    proposed = [
        name
        for name, click in completed.items()
        if name not in clicks or click.spread_m is not None
    ]
    if not proposed:
        return ()
    return (
        Assumption(
            quantity="points",
            value=", ".join(proposed),
            reason=(
                "Nobody clicked them: they are where a detector proposes them, and less sure than "
                "clicks."
            ),
        ),
    )


def scaled_clicks(clicks: Mapping[str, Click], scale: float) -> dict[str, Click]:
    """The clicks in a picture ``scale`` times as large."""
    return {
        name: replace(click, x=click.x * scale, y=click.y * scale) for name, click in clicks.items()
    }
