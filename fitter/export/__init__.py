"""Files for people and programs out of a fit's result."""

from fitter.export.bundle import artifacts, overlay_png, tapes_json, tapes_of

__all__ = ["artifacts", "overlay_png", "tapes_json", "tapes_of"]
