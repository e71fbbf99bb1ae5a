"""Whether a fit uses the detector, and where the detector is."""

from pathlib import Path

from fitter.detection.detector import Detector, installed_detector
from fitter.errors import DetectorUnavailableError
from fitter.request import FitRequest, SegmentationKind


def detector_for(request: FitRequest, weights: Path | None) -> Detector | None:
    """The detector, if the request can use it and it is installed.

    Parameters
    ----------
    weights
        Folder with its weights; None uses the installed package.

    Raises
    ------
    DetectorUnavailableError
        If points are to be proposed and no detector is installed.
    """
    seeds = request.mask is None and request.segmentation is SegmentationKind.SEEDED_GRABCUT
    if not (request.complete_clicks or request.slant_hints or seeds):
        return None
    try:
        return installed_detector(weights)
    except DetectorUnavailableError:
        if request.complete_clicks:
            raise
        return None
