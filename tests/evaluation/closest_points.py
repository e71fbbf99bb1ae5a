"""Distances of our surface from another mesh: closest points, weighed by area and robustly."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer
from scipy.spatial import KDTree

from fitter.arrays import Normals, Points3D, Triangles, Vertices
from fitter.numerics.meshes import vertex_areas
from fitter.numerics.normals import summed_cross_products
from fitter.numerics.rotations import unit_vectors

SURFACE_SPREAD_M = 0.005
"""What distances of surfaces are measured in."""

ROBUST_SCALE_M = 0.03
"""Geman-McClure's: fingers, ears and toes that differ in form pull less."""

BESIDE_M = 0.02
"""Twice the spacing of points on a mesh: nearer ones lie beside a point, not at a limb's end."""

SAME_WAY = 0.5
"""Cosine that normals of corresponding points have at least."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Surface:
    """A mesh, and points on it with unit normals: its vertices, then its triangles' centres."""

    vertices: Vertices
    triangles: Triangles
    points: Points3D
    normals: Normals
    tree: KDTree

    def nearest(self, points: Points3D) -> Integer[np.ndarray, " k"]:
        """Which of its points is nearest to each point."""
        return nearest_numbers(self.tree, points)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pairs:
    """Our vertices by number, how far each stands off along a direction, and with what weight."""

    ours: Integer[np.ndarray, " k"]
    along: Normals
    away_m: Float[np.ndarray, " k"]
    weights: Float[np.ndarray, " k"]


def closest_pairs(
    vertices: Vertices, triangles: Triangles, mesh: Surface
) -> tuple[tuple[Pairs, Pairs], float]:
    """Our vertices with a mesh's nearest points, and the mesh's with our nearest vertices.

    Also the energy of all, nats.
    """
    normals = unit_vectors(summed_cross_products(vertices, triangles))
    nearest = mesh.nearest(vertices)
    ours = nearest_numbers(KDTree(vertices), mesh.vertices)
    to_mesh, first = _weighed(
        np.arange(len(vertices)),
        vertices - mesh.points[nearest],
        mesh.normals[nearest],
        normals,
        vertex_areas(vertices, triangles),
    )
    to_ours, second = _weighed(
        ours,
        vertices[ours] - mesh.vertices,
        mesh.normals[: len(mesh.vertices)],
        normals[ours],
        vertex_areas(mesh.vertices, mesh.triangles),
    )
    return (to_mesh, to_ours), first + second


def distances_m(points: Points3D, surface: Surface) -> Float[np.ndarray, " k"]:
    """Distance of points from a surface: from the tangent plane of the nearest point of it."""
    far, nearest = surface.tree.query(points)
    offsets = points - surface.points[nearest]
    plane = np.abs(np.einsum("ij,ij->i", offsets, surface.normals[nearest]))
    # Beyond the end of a limb the plane says nothing.
    return np.where(far < BESIDE_M, plane, far)


def nearest_numbers(tree: KDTree, points: Points3D) -> Integer[np.ndarray, " k"]:
    """Which of a tree's points is nearest to each point."""
    _, numbers = tree.query(points)
    return np.asarray(numbers)


def _weighed(
    ours: Integer[np.ndarray, " k"],
    offsets: Points3D,
    along: Normals,
    normals: Normals,
    areas: Float[np.ndarray, " k"],
) -> tuple[Pairs, float]:
    """Distances along normals by area and Geman and McClure, and their energy.

    What faces another way counts as infinitely far.
    """
    away = np.einsum("ij,ij->i", offsets, along)
    facing = np.einsum("ij,ij->i", normals, along) > SAME_WAY
    share = areas / areas.mean()
    losses = np.where(facing, away**2 / (1.0 + (away / ROBUST_SCALE_M) ** 2), ROBUST_SCALE_M**2)
    weights = share * (1.0 + (away / ROBUST_SCALE_M) ** 2) ** -2
    pairs = Pairs(
        ours=ours[facing], along=along[facing], away_m=away[facing], weights=weights[facing]
    )
    return pairs, 0.5 * float(share @ losses) / SURFACE_SPREAD_M**2


def surface_of(vertices: Vertices, triangles: Triangles) -> Surface:
    """A mesh ready to be asked for nearest points."""
    corners = vertices[triangles]
    facets = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    points = np.concatenate([vertices, corners.mean(axis=1)])
    normals = np.concatenate([summed_cross_products(vertices, triangles), facets])
    return Surface(
        vertices=vertices,
        triangles=triangles,
        points=points,
        normals=unit_vectors(normals),
        tree=KDTree(points),
    )
