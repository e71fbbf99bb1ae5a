"""What registered meshes share: the template they were registered to, with its anatomy."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse
from scipy.sparse.linalg import splu
from scipy.spatial import KDTree

from fitter.arrays import Triangles, Vertices
from fitter.body.model import BodyModel
from fitter.numerics.gradient_operators import gradient_operator, weighted_laplacian
from fitter.training.articulation.part_tree import PART_NAMES
from fitter.training.articulation.parts import Parts
from fitter.training.assemble import BodyMesh
from fitter.training.shapes.surface import triangle_areas, vertex_areas

JOINT_LANDMARKS: Mapping[str, str] = {
    "shoulder": "upper_arm",
    "elbow": "forearm",
    "wrist": "hand",
    "hip": "thigh",
    "knee": "shin",
    "ankle": "foot",
}
"""Points inside the body that are the centres about which parts turn, unless a template places
them itself."""

BLEND_M = 0.03
"""How far skin follows the part next to its own, where only the part of each triangle is known: the
reach of the blend that painted weights have at elbows and knees."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Template:
    """A mesh with its anatomy.

    Attributes
    ----------
    name
        For the header: which topology this is.
    vertices
        (m, 3) a body at rest, body frame, metres.
    mesh
        Triangles, parts, joints, landmarks, texture layout and mirror map.
    """

    name: str
    vertices: Vertices
    mesh: BodyMesh


def packaged_template(model: BodyModel) -> Template:
    """The packaged model's own topology; bodies on it need say nothing but their vertices."""
    return Template(
        name=f"the packaged topology of {len(model.mean_vertices)} vertices",
        vertices=model.mean_vertices,
        mesh=BodyMesh(
            triangles=model.triangles,
            parts=Parts(
                part_of_triangle=model.part_of_triangle,
                skinning_parts=model.skinning_parts,
                skinning_weights=model.skinning_weights,
                incidence_pointers=model.incidence_pointers,
                incidence_vertices=model.incidence_vertices,
            ),
            joint_regressor=model.joint_regressor,
            landmarks=model.landmarks,
            uv=model.uv,
            uv_triangles=model.uv_triangles,
            mirror=model.mirror,
        ),
    )


def same_surface(first: BodyMesh, second: BodyMesh) -> bool:
    """Whether two meshes have the same triangles in the same parts, so that E means the same."""
    return np.array_equal(first.triangles, second.triangles) and np.array_equal(
        first.parts.part_of_triangle, second.parts.part_of_triangle
    )


def blended_weights(
    vertices: Vertices, triangles: Triangles, part_of_triangle: Integer[np.ndarray, " f"]
) -> Float[np.ndarray, "m p"]:
    """Skinning weights from a part for every triangle: its share of the skin, diffused.

    Solves (M + t L) w = M w₀ for every part, one step of heat flow, with areas M, the cotangent
    Laplacian L and t = :data:`BLEND_M` squared; the weights of a vertex keep summing to one.
    """
    areas = triangle_areas(vertices, triangles)
    corners = triangles.reshape(-1)
    shares = np.zeros((len(vertices), len(PART_NAMES)))
    np.add.at(shares, (corners, np.repeat(part_of_triangle, 3)), np.repeat(areas / 3.0, 3))
    laplacian = weighted_laplacian(gradient_operator(vertices, triangles), areas)
    mass = sparse.diags_array(vertex_areas(vertices, triangles))
    diffused = splu(sparse.csc_matrix(mass + BLEND_M**2 * laplacian)).solve(shares)
    diffused = np.maximum(diffused, 0.0)
    return diffused / diffused.sum(axis=1, keepdims=True)


def nearest_mirror(vertices: Vertices) -> Integer[np.ndarray, " m"]:
    """The vertex on the other side: the one nearest to the mirror image, where both agree.

    A vertex without such a partner is its own, so that the map is its own inverse on any mesh.
    """
    middle = 0.5 * (vertices[:, 0].min() + vertices[:, 0].max())
    mirrored = vertices * [-1.0, 1.0, 1.0] + [2.0 * middle, 0.0, 0.0]
    nearest = np.asarray(KDTree(vertices).query(mirrored)[1])
    every = np.arange(len(vertices))
    return np.where(nearest[nearest] == every, nearest, every).astype(np.int32)
