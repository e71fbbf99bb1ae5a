"""Files for people and programs out of a fit's result."""

from fitter.export.bundle import artifacts
from fitter.export.tapes import tapes_json

__all__ = ["artifacts", "tapes_json"]
