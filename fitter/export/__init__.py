"""Files for people and programs out of a fit's result."""

from fitter.export.bundle import overlay_png, result_files, tapes_json, tapes_of

__all__ = ["overlay_png", "result_files", "tapes_json", "tapes_of"]
