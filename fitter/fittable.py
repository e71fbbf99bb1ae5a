"""A gender's body model with everything prepared for fitting and measuring."""

from dataclasses import dataclass
from functools import cache

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.energies.instruments import BodyInstruments, body_instruments
from fitter.measurement.anthropometry import MeasuringBody, measuring_body
from fitter.request import Gender


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FittableBody:
    """What a fit needs of a gender."""

    instruments: BodyInstruments
    measuring: MeasuringBody


@cache
def packaged_body(gender: Gender) -> FittableBody:
    """The model shipped with the package; loaded and prepared once a process.

    Raises
    ------
    ModelFileError
        If the file is missing or damaged.
    """
    model = load_body_model(packaged_model_path(gender.value))
    instruments = body_instruments(model)
    return FittableBody(
        instruments=instruments, measuring=measuring_body(model, instruments.evaluator)
    )
