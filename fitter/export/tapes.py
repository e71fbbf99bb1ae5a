"""Where each measurement is taken, to be drawn on ``body_canonical.glb``."""

import json

from fitter.arrays import Shape, Vertices
from fitter.measurement.anthropometry import MeasuringBody, tape_lines
from fitter.result import FitResult

DECIMALS = 4
"""Of a metre: a tenth of a millimetre."""


def tapes_json(result: FitResult, measuring: MeasuringBody) -> bytes:
    """The lines of a fit's body; see :func:`tapes_of`."""
    return tapes_of(result.canonical_vertices, result.person.body.shape, measuring)


def tapes_of(canonical_vertices: Vertices, shape: Shape, measuring: MeasuringBody) -> bytes:
    """Lines by the measurements' names, in the frame of ``body_canonical.glb`` (feet on y = 0).

    Parameters
    ----------
    canonical_vertices
        (m, 3) body frame, metres.
    shape
        (n,) coefficients of that body.
    measuring
        The body it was measured with.
    """
    lowest = float(canonical_vertices[:, 1].min())
    lines = {
        name: (line - [0.0, lowest, 0.0]).round(DECIMALS).tolist()
        for name, line in tape_lines(measuring, shape).items()
    }
    document = {"frame": "metres, +y up", "lines": lines}
    return json.dumps(document, separators=(",", ":")).encode()
