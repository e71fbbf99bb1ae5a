"""Whether the person is lit: neither too dark nor burnt out."""

import numpy as np
from jaxtyping import UInt8

from fitter.capture.capture import Capture
from fitter.capture.finding import Code, Finding, Remark
from fitter.observation.colour import LUMINANCE_WEIGHTS, linear_from_display
from fitter.vocabulary.outcomes import Severity

DARKEST = 0.025
"""Least 90th percentile of the person's luminance, linear, of 1. Of the tuning pictures it is 0.17
to 0.74, and 0.07 of the darkest skin; with a twentieth of the light errors of hips grow by half and
of weights by a quarter."""

BURNT = 253
"""Value of a channel, of 255, from which there may have been more light than it shows."""

MOST_BURNT = 0.4
"""Largest share of the person's pixels that are burnt out. Of the tuning pictures it is 0.06 at
most, with three times the light 0.05 to 0.7; then errors of waist and weight grow by a sixth."""

_LINEAR_OF_BYTE = linear_from_display(np.arange(256) / 255.0)


def darkness(capture: Capture) -> Remark | None:
    """Whether even the brighter parts of the person, or of the picture, are dark."""
    luminance = bright_luminance(capture.picture[capture.region])
    if luminance >= DARKEST:
        return None
    return Finding(
        code=Code.TOO_DARK,
        severity=Severity.HARMS,
        reason=(
            f"The brighter parts of the person have {100.0 * luminance:.1f} % of the light that a "
            f"picture can show, and {100.0 * DARKEST:.1f} % is the least."
        ),
        remedy="Switch on more light, from the camera's side and not from behind the person.",
    )


def brightness(capture: Capture) -> Remark | None:
    """Whether much of the person is burnt out."""
    share = burnt_share(capture.picture[capture.region])
    if share < MOST_BURNT:
        return None
    return Finding(
        code=Code.TOO_BRIGHT,
        severity=Severity.HARMS,
        reason=(
            f"{100.0 * share:.0f} % of the person are burnt out, and {100.0 * MOST_BURNT:.0f} % is "
            "the most."
        ),
        remedy="Expose less: touch the person on the camera's screen, or leave the glaring light.",
    )


def bright_luminance(pixels: UInt8[np.ndarray, "k 3"]) -> float:
    """The 90th percentile of linear luminance in [0, 1]."""
    return float(np.percentile(_LINEAR_OF_BYTE[pixels] @ LUMINANCE_WEIGHTS, 90.0))


def burnt_share(pixels: UInt8[np.ndarray, "k 3"]) -> float:
    """Share of pixels with a channel that may be cut off."""
    return float(np.mean(pixels.max(axis=1) >= BURNT))
