"""The body models, prepared for fitting and measuring, and the detector: loaded once a process."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from fitter.detection.detector import Detector, installed_detector
from fitter.energies.fitting_operators import FittingOperators, searched_operators
from fitter.errors import DetectorUnavailableError
from fitter.fits.usable_model import model_path, usable_model
from fitter.measurement.anthropometry import MeasuringBody, measuring_body
from fitter.population.conditional_shape import MeasuredPopulation, measured_population
from fitter.pose_init.landmark_rig import rig_space
from fitter.request import View
from fitter.vocabulary.choices import Gender, SegmentationKind


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PreparedModel:
    """A gender's model and what fits need besides.

    Attributes
    ----------
    operators
        Of the whole body: what is drawn and reported.
    searched
        Of the lighter body that searches use.
    measuring, population
        Tapes on the whole body, and what they measure on the people it was learned from.
    """

    operators: FittingOperators
    searched: FittingOperators
    measuring: MeasuringBody
    population: MeasuredPopulation


def prepared_model(gender: Gender, *, models: Path | None = None) -> PreparedModel:
    """A gender's model, prepared once a process.

    See :func:`usable_model` for the arguments.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged, of the other gender, or lacks something a fit needs.
    """
    return _prepared(model_path(gender, models=models), gender)


@cache
def _prepared(source: Path, gender: Gender) -> PreparedModel:
    model = usable_model(gender, models=source.parent)
    searched = searched_operators(model)
    assert searched.whole is not None
    operators = searched.whole.operators
    measuring = measuring_body(model, operators.evaluator)
    # Found once here, every process forked later has it.
    rig_space(searched.model)
    return PreparedModel(
        operators=operators,
        searched=searched,
        measuring=measuring,
        population=measured_population(measuring),
    )


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


PACKAGED: Final = Equipment()
"""The models and the detector of the packages."""
