"""Coordinates of a body's surface along the regions that clothes and limbs go round.

A ring is what has the same position along its region: the trunk and the legs go from the crown
down, the arms from the shoulder out, face and neck down. Hands and scalp have none.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.applications.surface_field import smooth_values
from fitter.arrays import Vector3
from fitter.body.model import BodyModel, regress
from fitter.numerics.rotations import unit_vectors

_HAIRLINE = 0.5
# Of the way from the eyes up to the crown.
_NAPE_M = 0.03
# Below the ears; hair that is cut ends there.
_EAR_OUTWARD_M, _EAR_REACH_M = 0.003, 0.045
# Farther out than the ears' landmarks, and that near to them in height, there are only ears.
_FACE_SHARE = 0.35
# Of the way from ears to nose: eyes, nose and mouth lie ahead of it.

BORDER_M = 0.015
"""Over which regions blend: cut along triangles, hairline and neckline would have teeth."""


class Region(IntEnum):
    """Region with a profile of its own."""

    TRUNK = 0
    ARMS = 1
    HANDS = 2
    FACE = 3
    SCALP = 4


_REGION_OF_PART: Mapping[str, Region] = {
    "upper_arm": Region.ARMS, "forearm": Region.ARMS, "hand": Region.HANDS,
    "neck": Region.FACE, "head": Region.FACE,
}  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RingCoordinates:
    """Coordinates of a body model's surface along its regions.

    Attributes
    ----------
    region
        (f,) :class:`Region` of each triangle.
    along_m
        (5, m) position of each vertex along each region, metres at rest; 0 in hands and scalp.
    shares
        (5, m) share of each vertex in each region; regions blend over :data:`BORDER_M`.
    features
        (m,) weight of eyes, nose or mouth at each vertex: 0 to 1.
    """

    region: Integer[np.ndarray, " f"]
    along_m: Float[np.ndarray, "regions m"]
    shares: Float[np.ndarray, "regions m"]
    features: Float[np.ndarray, " m"]

    @classmethod
    @lru_cache(maxsize=2)
    def of(cls, model: BodyModel) -> "RingCoordinates":
        """Coordinates of a body model, from its mean body at rest."""
        kinds = [name.removeprefix("left_").removeprefix("right_") for name in model.part_names]
        of_part = np.array([_REGION_OF_PART.get(kind, Region.TRUNK) for kind in kinds])
        region = of_part[model.part_of_triangle]
        centres = model.mean_vertices[model.triangles].mean(axis=1)
        region[(region == Region.FACE) & _under_hair(model, centres)] = Region.SCALP
        height = model.mean_vertices[:, 1]
        nowhere = np.zeros(len(height))
        along = np.stack([height, _along_arms(model), nowhere, height, nowhere])
        fields = np.stack(
            [*(_of_vertices(model, region == each) for each in Region), _features(model)]
        )
        smooth = np.clip(smooth_values(model, fields.T, over_m=BORDER_M).T, 0.0, 1.0)
        shares = smooth[:-1] / smooth[:-1].sum(axis=0)
        return cls(
            region=region,
            along_m=along,
            shares=shares,
            features=smooth[-1],
        )


def _of_vertices(model: BodyModel, triangles: Bool[np.ndarray, " f"]) -> Float[np.ndarray, " m"]:
    """Which share of the triangles round each vertex is among those."""
    corners, count = model.triangles.ravel(), len(model.mean_vertices)
    own = np.bincount(corners, np.repeat(triangles, 3), count)
    return own / np.bincount(corners, minlength=count)


def _features(model: BodyModel) -> Float[np.ndarray, " m"]:
    """Which vertices lie on the front of the face."""
    chin, ears = landmark(model, "chin"), _middle(model, "ear")
    _, y, z = model.mean_vertices.T
    ahead = z > ears[2] + _FACE_SHARE * (landmark(model, "nose")[2] - ears[2])
    return (ahead & (y > chin[1]) & ~_under_hair(model, model.mean_vertices)).astype(np.float64)


def _along_arms(model: BodyModel) -> Float[np.ndarray, " m"]:
    """Distance of each vertex from its side's shoulder, along the straight arm."""
    along = np.empty(len(model.mean_vertices))
    left = model.mean_vertices[:, 0] >= 0.0
    for side, own in (("left", left), ("right", ~left)):
        shoulder, wrist = (landmark(model, f"{side}_{name}") for name in ("shoulder", "wrist"))
        axis = unit_vectors(wrist - shoulder)
        along[own] = (model.mean_vertices[own] - shoulder) @ axis
    return along


def _under_hair(model: BodyModel, points: Float[np.ndarray, "k 3"]) -> Bool[np.ndarray, " k"]:
    """Which points of the head hair grows on.

    Those above a line from hairline to ears, and behind, but for the ears.
    """
    eyes, ears = _middle(model, "eye"), _middle(model, "ear")
    crown = landmark(model, "head_top")
    hairline_y = eyes[1] + _HAIRLINE * (crown[1] - eyes[1])
    slope = (hairline_y - ears[1]) / (eyes[2] - ears[2])
    ahead, above = points[:, 2] - ears[2], points[:, 1] - ears[1]
    outward = np.abs(points[:, 0]) - abs(landmark(model, "left_ear")[0])
    on_ear = (outward > _EAR_OUTWARD_M) & (np.abs(above) < _EAR_REACH_M)
    return ~on_ear & np.where(ahead > 0.0, above > slope * ahead, above > -_NAPE_M)


def _middle(model: BodyModel, name: str) -> Vector3:
    """Between the left and the right one."""
    return 0.5 * (landmark(model, f"left_{name}") + landmark(model, f"right_{name}"))


def landmark(model: BodyModel, name: str) -> Vector3:
    """A landmark of the mean body at rest, metres."""
    points = regress(model.landmarks, model.mean_vertices)
    return points[model.landmarks.names.index(name)]
