"""The public names of the fitter and where they are defined."""

from .errors import FitterError as FitterError
from .errors import InvalidInputError as InvalidInputError
from .errors import ModelFileError as ModelFileError
from .errors import NumericalError as NumericalError
from .fits.equipment import Equipment as Equipment
from .fits.progress import Progress as Progress
from .fits.progress import Stage as Stage
from .library import body_vertices as body_vertices
from .library import estimate_body as estimate_body
from .library import files_of as files_of
from .library import fit as fit
from .library import measure as measure
from .measurement.definitions import Measurement as Measurement
from .parameters import BodyParameters as BodyParameters
from .parameters import Light as Light
from .parameters import Reflectance as Reflectance
from .person.fitted_person import FittedPerson as FittedPerson
from .population.body_estimate import BodyEstimate as BodyEstimate
from .render.camera import Camera as Camera
from .request import Choices as Choices
from .request import Click as Click
from .request import FitRequest as FitRequest
from .request import KnownMeasurement as KnownMeasurement
from .request import LightGuess as LightGuess
from .request import Paper as Paper
from .request import Person as Person
from .request import View as View
from .result import FitResult as FitResult
from .result import FitStage as FitStage
from .result import FittedView as FittedView
from .result import PictureFit as PictureFit
from .result import StageBody as StageBody
from .vocabulary.choices import Clothing as Clothing
from .vocabulary.choices import Cues as Cues
from .vocabulary.choices import Facing as Facing
from .vocabulary.choices import Gender as Gender
from .vocabulary.choices import LightKind as LightKind
from .vocabulary.choices import OptimizerKind as OptimizerKind
from .vocabulary.choices import PaperEnergy as PaperEnergy
from .vocabulary.choices import ViewKind as ViewKind
from .vocabulary.outcomes import LimbFacing as LimbFacing
from .vocabulary.outcomes import Outcome as Outcome
from .vocabulary.outcomes import Verdict as Verdict
from .vocabulary.remarks import Remark as Remark

__all__ = [
    "BodyEstimate",
    "BodyParameters",
    "Camera",
    "Choices",
    "Click",
    "Clothing",
    "Cues",
    "Equipment",
    "Facing",
    "FitRequest",
    "FitResult",
    "FitStage",
    "FittedPerson",
    "FittedView",
    "FitterError",
    "Gender",
    "InvalidInputError",
    "KnownMeasurement",
    "Light",
    "LightGuess",
    "LightKind",
    "LimbFacing",
    "Measurement",
    "ModelFileError",
    "NumericalError",
    "OptimizerKind",
    "Outcome",
    "Paper",
    "PaperEnergy",
    "Person",
    "PictureFit",
    "Progress",
    "Reflectance",
    "Remark",
    "Stage",
    "StageBody",
    "Verdict",
    "View",
    "ViewKind",
    "body_vertices",
    "estimate_body",
    "files_of",
    "fit",
    "measure",
]
