"""The body models and the detector that every fit uses, loaded once."""

from dataclasses import dataclass
from pathlib import Path

from fitter.detection.detector import Detector, installed_detector
from fitter.errors import DetectorUnavailableError
from fitter.fits.prepared_model import PreparedModel, prepared_model
from fitter.request import View
from fitter.vocabulary.choices import Gender, SegmentationKind


@dataclass(frozen=True, slots=True, kw_only=True)
class Equipment:
    """Folders of the body models and the detector's weights; each is loaded once a process.

    Attributes
    ----------
    models
        Folder of the body models; None for those of the package.
    detector_weights
        Folder of the detector's weights; None for those of their package.
    """

    models: Path | None = None
    detector_weights: Path | None = None

    def model(self, gender: Gender) -> PreparedModel:
        """A gender's body model.

        Raises
        ------
        ModelFileError
            If it is missing or damaged, or lacks something a fit needs.
        """
        return prepared_model(gender, models=self.models)

    def detector_for(self, view: View) -> Detector | None:
        """The detector, if the reading of a picture can use it and it is installed.

        Raises
        ------
        DetectorUnavailableError
            If points are to be proposed and no detector is installed.
        """
        seeds = view.mask is None and view.segmentation is SegmentationKind.SEEDED_GRABCUT
        if not (view.complete_clicks or view.slant_hints or seeds):
            return None
        try:
            return installed_detector(self.detector_weights)
        except DetectorUnavailableError:
            if view.complete_clicks:
                raise
            return None
