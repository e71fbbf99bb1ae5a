"""A person from one picture or several, as a scan measures them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.fits.pipeline import fit
from fitter.fits.scan import ScanView, scan
from fitter.measurement.quantity import Measurement
from fitter.person.several_pictures import known_covariance
from fitter.request import Posture, ViewKind
from fitter.result import PictureFit


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ScanFit:
    """One person from their pictures.

    Attributes
    ----------
    shape, covariance
        (n,) coefficients and their (n, n) covariance.
    pictures
        The person as found in each picture, in the order given.
    measurements
        Of the shape.
    given
        Names of those the requests gave.
    """

    shape: Shape
    covariance: Float[np.ndarray, "n n"]
    pictures: tuple[PictureFit, ...]
    measurements: tuple[Measurement, ...]
    given: tuple[str, ...]


def scan_fit(views: Sequence[ScanView]) -> ScanFit:
    """All pictures of a person together; one by itself, told as much as a scan is."""
    if len(views) == 1:
        return _alone(views[0])
    found = scan(views)
    return ScanFit(
        shape=found.shape,
        covariance=found.covariance,
        pictures=tuple(view.found for view in found.views),
        measurements=found.measurements,
        given=found.given,
    )


def _alone(view: ScanView) -> ScanFit:
    posture = Posture.ANY if view.kind is ViewKind.OTHER else Posture.MEASURED
    result = fit(replace(view.request, posture=posture))
    return ScanFit(
        shape=result.person.body.shape,
        covariance=known_covariance(result.person),
        pictures=(result.found,),
        measurements=result.measurements,
        given=result.given,
    )
