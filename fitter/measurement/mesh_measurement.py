"""Measure meshes of the model's topology that no shape coefficients describe exactly.

A registered scan, a held-out subject, a file: the mesh in the canonical and in the standing pose,
lying anywhere. A tape is level by the body's own upright, so the mesh is first brought to where the
model stands: by the rigid motion that, together with a shape, fits the model to it best. For a body
of the shape space that motion is exact whatever its shape; one found without a shape would tilt
with a belly.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex, Points3D, Vector3, Vertices
from fitter.body.model import regress
from fitter.measurement.affine_body import AffineBody
from fitter.measurement.anthropometry import MeasuringBody, measurement_values
from fitter.numerics.meshes import vertex_areas
from fitter.numerics.rotations import rotation_matrices

STRIDE = 4
"""Every fourth vertex tells the motion: three thousand are plenty for 26 unknowns."""

STEPS = 5
"""Gauss-Newton steps; the fourth still moves a body beyond three deviations by a nanometre."""


def mesh_measurement_values(
    body: MeasuringBody, canonical: Vertices, standing: Vertices
) -> Float[np.ndarray, " k"]:
    """Measurements of one body from its meshes in both poses, in the body frame.

    Parameters
    ----------
    body
        Of the model whose topology the meshes have; its landmarks and definitions are used.
    canonical, standing
        (m, 3) body frame (y up, z forward), metres; :func:`in_body_frame` brings them there.
    """
    fixed = replace(
        body,
        canonical=_unchanging(canonical),
        canonical_points=_unchanging(regress(body.points, canonical)),
        standing_points=_unchanging(regress(body.points, standing)),
    )
    return measurement_values(fixed, np.zeros(0))


def in_body_frame(posed: AffineBody, body: MeasuringBody, vertices: Vertices) -> Vertices:
    """A mesh moved rigidly to where the model stands in the same pose.

    Minimises Σ_v a_v |R x_v + t - (μ_v + β · U_v)|² over rotation R, translation t and shape β,
    with areas a: linear but for R, which Gauss-Newton finds from the best rotation onto the mean.

    Parameters
    ----------
    posed
        The model in the pose of the mesh.
    body
        Gives the mesh's triangles.
    vertices
        (m, 3) metres, moved by any rotation and translation.
    """
    chosen = slice(None, None, STRIDE)
    areas = vertex_areas(posed.mean, body.triangles)[chosen]
    mean = posed.mean[chosen]
    shapes = posed.derivative[:, chosen].reshape(len(posed.derivative), -1)
    shifts = np.tile(np.eye(3), len(mean))
    motion = _best_motion(vertices[chosen], mean, areas)
    for _ in range(STEPS):
        moved = motion.of(vertices[chosen])
        centre = np.average(moved, axis=0, weights=areas)
        # A small turn ω moves a point by ω x (point - centre).
        turns = np.stack([np.cross(axis, moved - centre).ravel() for axis in np.eye(3)])
        rows = np.concatenate([turns, shifts, -shapes])
        weighted = rows * np.repeat(areas, 3)
        step = np.linalg.solve(weighted @ rows.T, weighted @ (mean - moved).ravel())
        turn = rotation_matrices(step[None, :3])[0]
        motion = _Motion(
            rotation=turn @ motion.rotation,
            translation=turn @ (motion.translation - centre) + centre + step[3:6],
        )
    return motion.of(vertices)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Motion:
    """A rigid motion R x + t."""

    rotation: Float[np.ndarray, "3 3"]
    translation: Vector3

    def of(self, points: Points3D) -> Points3D:
        return points @ self.rotation.T + self.translation


def _best_motion(points: Points3D, target: Points3D, weights: PerVertex) -> _Motion:
    """The rigid motion of points onto a target in the least-squares sense (Kabsch)."""
    centre, goal = (np.average(each, axis=0, weights=weights) for each in (points, target))
    left, _, right = np.linalg.svd(((target - goal) * weights[:, None]).T @ (points - centre))
    rotation = left * [1.0, 1.0, np.linalg.det(left @ right)] @ right
    return _Motion(rotation=rotation, translation=goal - rotation @ centre)


def _unchanging(points: Points3D) -> AffineBody:
    """A body that no coefficient changes."""
    return AffineBody(mean=points, derivative=np.zeros((0, *points.shape)))
