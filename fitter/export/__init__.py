"""Files for people and programs out of a fit's result."""

from fitter.export.bundle import artifacts

__all__ = ["artifacts"]
