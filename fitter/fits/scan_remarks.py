"""What a fit says about itself: pictures of different people, from other sides, and wrong words.

Each is found by a residual: what one picture says of the shape against the others, how a fitted
body is turned against the view that was announced, and what all pictures say of a measurement
against what was given.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from fitter.fits.foretold import Foretold
from fitter.numerics.rotations import rotation_matrices
from fitter.parameters import BodyParameters
from fitter.person.several_pictures import CombinedShape
from fitter.remarks import FitWarning
from fitter.request import ViewKind

MOST_TURNED_DEG = 50.0
"""From the announced view; half way to the next, and a little."""

MOST_DEVIATIONS = 3.0
"""Standard errors by which what was given may differ from what pictures say of it."""

_ANNOUNCED_DEG = {ViewKind.FRONT: 0.0, ViewKind.SIDE: 90.0, ViewKind.BACK: 180.0}
_SAID = {ViewKind.FRONT: "the front", ViewKind.SIDE: "the side", ViewKind.BACK: "behind"}


def person_warnings(
    alone: CombinedShape | None,
    foretold: Sequence[Foretold],
    units: Mapping[str, str],
    views: Sequence[ViewKind | None],
    bodies: Sequence[BodyParameters],
) -> tuple[FitWarning, ...]:
    """What the caller should look at, in the fit as a whole.

    ``alone`` is what several pictures say of the shape, each by itself; ``units`` are by
    measurement. A warning about one of several pictures names it by its place.
    """
    several = len(views) > 1
    warnings = [
        warning
        for number, (view, body) in enumerate(zip(views, bodies, strict=True))
        if (warning := _other_view(f"views.{number}" if several else "The picture", view, body))
    ]
    warnings += [warning for each in foretold if (warning := _contradicted(each, units[each.name]))]
    if alone is not None and alone.doubtful:
        warnings.append(_different_people(alone))
    return tuple(warnings)


def turned_deg(body: BodyParameters) -> float:
    """How far a body is turned from facing the camera, degrees in [0, 180]."""
    forward = rotation_matrices(body.pose[:1])[0][:, 2]
    return float(np.degrees(np.arctan2(np.hypot(forward[0], forward[1]), forward[2])))


def _other_view(place: str, view: ViewKind | None, body: BodyParameters) -> FitWarning | None:
    if view in (None, ViewKind.OTHER):
        return None
    found = turned_deg(body)
    if abs(found - _ANNOUNCED_DEG[view]) <= MOST_TURNED_DEG:
        return None
    return FitWarning(
        code="other-view",
        message=(
            f"{place} is said to be from {_SAID[view]}, but the body found in it is turned "
            f"by {found:.0f} degrees from facing the camera. Check the view, whether left and "
            "right are the person's own, and whether the picture is mirrored."
        ),
    )


def _contradicted(told: Foretold, unit: str) -> FitWarning | None:
    if abs(told.given - told.value) <= MOST_DEVIATIONS * told.standard_error:
        return None
    return FitWarning(
        code="given-contradicted",
        message=(
            f"{told.name} was given as {told.given:.1f} {unit}, but by the pictures and the "
            f"height it is {told.value:.0f} ± {1.96 * told.standard_error:.0f} {unit}. Check "
            "this value and the height, and their units."
        ),
    )


def _different_people(alone: CombinedShape) -> FitWarning:
    return FitWarning(
        code="different-people",
        message=(
            f"The pictures seem to show different people: the body in views.{alone.differing} "
            "differs from that in the others as pictures of one person hardly do. Check that view "
            "and its points, and left and right in it."
        ),
    )
