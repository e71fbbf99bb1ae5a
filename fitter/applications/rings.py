"""Where the surface of a body lies along the regions that clothes and limbs go round.

A ring is what has the same position along its region: the trunk and the legs go from the crown
down, the arms from the shoulder out, face and neck down. Hands and scalp are one ring each.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.applications.seen_surface import SurfacePoints
from fitter.arrays import Vector3
from fitter.body.model import BodyModel
from fitter.body.skeleton import regress
from fitter.numerics.vectors import unit_vectors

_HAIRLINE = 0.5
# Of the way from the eyes up to the crown.
_NAPE_M = 0.03
# Below the ears; hair that is cut ends there.


class Region(IntEnum):
    """What has a profile of its own."""

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
    """Where the surface of a body model lies along its regions.

    Attributes
    ----------
    region
        (f,) :class:`Region` of each triangle.
    along_m
        (5, m) position of each vertex along each region, metres on the mean body; hands and
        scalp have one colour only.
    """

    region: Integer[np.ndarray, " f"]
    along_m: Float[np.ndarray, "regions m"]

    @classmethod
    def of(cls, model: BodyModel) -> "RingCoordinates":
        """Of a body model, from its mean body at rest."""
        kinds = [name.removeprefix("left_").removeprefix("right_") for name in model.part_names]
        of_part = np.array([_REGION_OF_PART.get(kind, Region.TRUNK) for kind in kinds])
        region = of_part[model.part_of_triangle]
        centres = model.mean_vertices[model.triangles].mean(axis=1)
        region[(region == Region.FACE) & _under_hair(model, centres)] = Region.SCALP
        height = model.mean_vertices[:, 1]
        nowhere = np.zeros(len(height))
        along = np.stack([height, _along_arms(model), nowhere, height, nowhere])
        return cls(region=region, along_m=along)

    def of_points(
        self, triangles: Integer[np.ndarray, " k"], points: SurfacePoints
    ) -> tuple[Integer[np.ndarray, " k"], Float[np.ndarray, " k"]]:
        """Region of points on given triangles, and their position along it, metres."""
        region = self.region[triangles]
        of_corners = self.along_m[region[:, None], points.corners]
        return region, (points.weights * of_corners).sum(axis=1)


def _along_arms(model: BodyModel) -> Float[np.ndarray, " m"]:
    """Distance of each vertex from its side's shoulder, along the straight arm."""
    along = np.empty(len(model.mean_vertices))
    left = model.mean_vertices[:, 0] >= 0.0
    for side, own in (("left", left), ("right", ~left)):
        shoulder, wrist = (_landmark(model, f"{side}_{name}") for name in ("shoulder", "wrist"))
        axis = unit_vectors(wrist - shoulder)
        along[own] = (model.mean_vertices[own] - shoulder) @ axis
    return along


def _under_hair(model: BodyModel, points: Float[np.ndarray, "k 3"]) -> Bool[np.ndarray, " k"]:
    """Which points of the head hair grows on: above a line from hairline to ears, and behind."""
    eyes, ears = (
        0.5 * (_landmark(model, f"left_{name}") + _landmark(model, f"right_{name}"))
        for name in ("eye", "ear")
    )
    crown = _landmark(model, "head_top")
    hairline_y = eyes[1] + _HAIRLINE * (crown[1] - eyes[1])
    slope = (hairline_y - ears[1]) / (eyes[2] - ears[2])
    ahead = points[:, 2] - ears[2]
    return np.where(
        ahead > 0.0, points[:, 1] > ears[1] + slope * ahead, points[:, 1] > ears[1] - _NAPE_M
    )


def _landmark(model: BodyModel, name: str) -> Vector3:
    points = regress(model.landmarks, model.mean_vertices)
    return points[model.landmarks.names.index(name)]
