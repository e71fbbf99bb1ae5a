"""Points of the skin, dense enough to measure distances from, with the part each belongs to."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import Normals, Vertices
from tests.accuracy.landmark_points import packaged_model, rest_landmarks
from tests.accuracy.meshes import vertex_normals
from tests.accuracy.people import rig_of_people
from tests.accuracy.staging import Staged

ARM_PARTS = ("upper_arm", "forearm", "hand")
LEG_PARTS = tuple(
    f"{side}_{part}" for side in ("left", "right") for part in ("thigh", "shin", "foot")
)

SPACING_M = 0.009


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SkinSamples:
    """``points`` and ``normals`` (s, 3) in the world, ``rest`` (s, 3) at rest, ``parts`` (s,)."""

    points: Vertices
    normals: Normals
    rest: Vertices
    parts: Integer[np.ndarray, " s"]
    part_names: tuple[str, ...]
    arm_ends: dict[str, tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]]

    def is_part(self, name: str) -> Bool[np.ndarray, " s"]:
        """Which samples belong to a part."""
        return self.parts == self.part_names.index(name)

    def of(self, names: Sequence[str]) -> "SkinSamples":
        """The samples of some parts."""
        return self.chosen(np.isin(self.parts, [self.part_names.index(name) for name in names]))

    def chosen(self, chosen: Bool[np.ndarray, " s"]) -> "SkinSamples":
        """Some of the samples."""
        return SkinSamples(
            points=self.points[chosen],
            normals=self.normals[chosen],
            rest=self.rest[chosen],
            parts=self.parts[chosen],
            part_names=self.part_names,
            arm_ends=self.arm_ends,
        )

    def along_arm(self, samples: "SkinSamples", side: str) -> Float[np.ndarray, " s"]:
        """0 at the shoulder, 1 at the wrist, at rest."""
        shoulder, wrist = self.arm_ends[side]
        arm = wrist - shoulder
        return (samples.rest - shoulder) @ arm / (arm @ arm)


def skin_samples(staged: Staged) -> SkinSamples:
    """Sample the posed body's triangles evenly."""
    model = packaged_model(staged.person.gender)
    triangles = rig_of_people().surface.triangles
    rest = rig_of_people().surface.body(staged.person.source_vertices)
    normals = vertex_normals(staged.body, triangles)
    first, second, third = (staged.body[triangles[:, k]] for k in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(second - first, third - first), axis=1)
    counts = np.maximum(np.ceil(areas / SPACING_M**2).astype(int), 1)
    owners = np.repeat(np.arange(len(triangles)), counts)
    number = np.arange(len(owners)) - np.repeat(np.cumsum(counts) - counts, counts)
    # Kronecker's sequence of the plastic number spreads points evenly over each triangle.
    u, v = (number * 0.7548776662466927 + 0.5) % 1.0, (number * 0.5698402909980532 + 0.5) % 1.0
    over = u + v > 1.0
    u, v = np.where(over, 1.0 - u, u), np.where(over, 1.0 - v, v)
    shares = np.stack([1.0 - u - v, u, v], axis=1)[:, :, None]

    def spread(values: Vertices) -> Vertices:
        return (shares * values[triangles[owners]]).sum(axis=1)

    directions = spread(normals)
    marks = rest_landmarks(staged.person)
    return SkinSamples(
        points=spread(staged.body),
        normals=directions / np.linalg.norm(directions, axis=1, keepdims=True),
        rest=spread(rest),
        parts=model.part_of_triangle[owners],
        part_names=model.part_names,
        arm_ends={
            side: (marks[f"{side}_shoulder"], marks[f"{side}_wrist"]) for side in ("left", "right")
        },
    )
