"""How tall a body is: the one definition that training, height constraint and report share."""

from fitter.arrays import Vertices
from fitter.body.model import SparseRows
from fitter.body.skeleton import regress


def stature_m(standing_vertices: Vertices, landmarks: SparseRows) -> float:
    """Crown above the soles, metres.

    Section 4 measures height on a mesh in a predefined standing pose. Landmarks are fixed weighted
    sums of vertices, so this is linear in the shape where the highest and lowest vertex would not
    be, and one axis of the shape space can carry it exactly.

    Parameters
    ----------
    standing_vertices
        (m, 3) the body in the model's ``standing_pose``, body frame (y up), metres.
    landmarks
        The model's landmark rows, with ``crown``, ``sole_left`` and ``sole_right``.
    """
    heights = regress(landmarks, standing_vertices)[:, 1]
    crown, left, right = (
        float(heights[landmarks.names.index(name)]) for name in ("crown", "sole_left", "sole_right")
    )
    return crown - 0.5 * (left + right)
