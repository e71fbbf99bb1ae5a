"""A body model on fewer vertices, for searching: the same bodies, shapes and poses.

Two thirds of the triangles of a whole body cover head, hands and feet, where they are a fraction of
a pixel and of no weight in the energies; with them a fit takes a quarter longer. Which vertices and
triangles remain is in the model's file (:mod:`fitter.training.shapes.decimation`). The lighter
model is a SCAPE model of its own on the decimated mean body: its triangles have the deformation
gradients of the decimated bodies, so shapes and rigid turns are exact, and the pose-dependent
right-hand sides of a vertex that went act on the corners of the triangle that took its place.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Integer
from scipy import sparse
from scipy.sparse.linalg import splu

from fitter.arrays import PerVertex, Vertices
from fitter.body.model import BodyModel, LighterMesh, SparseRows
from fitter.numerics.meshes import triangle_areas, vertex_areas
from fitter.numerics.surface_sample import SurfaceSample

Shapes = Float[np.ndarray, "n1 m 3"]
LighterShapes = Float[np.ndarray, "n1 k 3"]

_OWN_SUPPORT = 8
"""Rows over no more vertices than these keep all of them."""

_RANK = 1e-3
"""Directions of shape that move a row's vertices less than this share of the mean body's extent
are met in the mean square only."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LighterModel:
    """A lighter model with its place on the whole one.

    Attributes
    ----------
    model
        On k vertices; ``uv``, ``mirror`` and ``lighter`` are for a whole body and say nothing.
    kept
        (k,) the vertices of the whole model, ascending.
    vertex_count
        m, of the whole model.
    """

    model: BodyModel
    kept: Integer[np.ndarray, " k"]

    vertex_count: int

    def lifted(self, values: np.ndarray) -> np.ndarray:
        """(m, ...) the values (k, ...) at the vertices that were kept, zero at the others."""
        whole = np.zeros((self.vertex_count, *values.shape[1:]), dtype=values.dtype)
        whole[self.kept] = values
        return whole

    def whole_sample(self, sample: SurfaceSample) -> SurfaceSample:
        """The same sample of the surface as one of the whole body's."""
        return replace(sample, vertices=self.kept[sample.vertices], areas=self.lifted(sample.areas))


def lighter_model(model: BodyModel) -> LighterModel:
    """Express a model on its lighter mesh."""
    lighter = model.lighter
    held = held_vertices((model.landmarks, model.joint_regressor), len(model.mean_vertices))
    kept = lighter.kept
    shapes = np.concatenate([model.mean_vertices[None], model.shape_basis])
    fitted = _fitted(shapes, lighter, held, vertex_areas(model.mean_vertices, model.triangles))
    pointers, vertices, pose_terms = _incidences(model, lighter)
    return LighterModel(
        model=replace(
            model,
            triangles=lighter.triangles,
            mean_vertices=np.ascontiguousarray(fitted[0]),
            shape_basis=np.ascontiguousarray(fitted[1:]),
            part_of_triangle=model.part_of_triangle[lighter.origin],
            triangle_weights=_triangle_weights(model, lighter, fitted[0]),
            joint_regressor=_moved(model.joint_regressor, lighter, shapes, fitted),
            skinning_parts=model.skinning_parts[kept],
            skinning_weights=model.skinning_weights[kept],
            incidence_pointers=pointers,
            incidence_vertices=vertices,
            pose_right_hand_sides=pose_terms,
            landmarks=_moved(model.landmarks, lighter, shapes, fitted),
            uv=np.zeros((1, 2)),
            uv_triangles=np.zeros_like(lighter.triangles),
            mirror=np.full(len(kept), -1, dtype=np.int32),
        ),
        kept=kept,
        vertex_count=len(model.mean_vertices),
    )


def held_vertices(rows: Sequence[SparseRows], count: int) -> Bool[np.ndarray, " m"]:
    """Vertices that stay where they are: those of landmarks and joints that have few."""
    held = np.zeros(count, dtype=np.bool_)
    for each in rows:
        sizes = np.diff(each.pointers)
        held[each.indices[np.repeat(sizes <= _OWN_SUPPORT, sizes)]] = True
    return held


def _fitted(
    shapes: Shapes,
    lighter: LighterMesh,
    held: Bool[np.ndarray, " m"],
    areas: PerVertex,
) -> LighterShapes:
    """(n + 1, k, 3) lighter bodies through the middle of the whole ones' skin.

    Vertices alone would span a surface inside all that is convex: feet and a head that are too
    small put the body too near the camera. So the vertices are moved to where the surface is
    nearest to all of the whole one's, in the mean square by area; those held stay. Being linear,
    it holds for every shape alike.
    """
    m, k = len(held), len(lighter.kept)
    rows = np.repeat(np.arange(m), 3)
    spread = sparse.csc_array(
        (lighter.shares.ravel(), (rows, lighter.corners.ravel())), shape=(m, k)
    )
    columns = shapes.transpose(1, 0, 2).reshape(m, -1)
    free = np.flatnonzero(~held[lighter.kept])
    result = columns[lighter.kept]
    fixed = result.copy()
    fixed[free] = 0.0
    weighted = spread[:, free].T @ sparse.diags_array(areas)
    normal = sparse.csc_matrix(weighted @ spread[:, free])
    result[free] = splu(normal).solve(weighted @ (columns - spread @ fixed))
    return result.reshape(k, len(shapes), 3).transpose(1, 0, 2)


def _triangle_weights(
    model: BodyModel, lighter: LighterMesh, fitted: Vertices
) -> Float[np.ndarray, " g"]:
    """The weights of the triangles that remain, in proportion to what they have grown to."""
    grown = triangle_areas(fitted, lighter.triangles)
    areas = triangle_areas(model.mean_vertices, model.triangles[lighter.origin])
    return model.triangle_weights[lighter.origin] * grown / areas


def _incidences(
    model: BodyModel, lighter: LighterMesh
) -> tuple[Integer[np.ndarray, " p1"], Integer[np.ndarray, " i"], Float[np.ndarray, "i 3 nine_q"]]:
    """Vertices that each part's triangles touch, or those around one they touched, with terms."""
    pointers = [0]
    vertices: list[np.ndarray] = []
    terms: list[np.ndarray] = []
    parts = model.part_of_triangle[lighter.origin]
    for part in range(len(model.part_names)):
        rows = slice(model.incidence_pointers[part], model.incidence_pointers[part + 1])
        whole = model.incidence_vertices[rows]
        corners = lighter.corners[whole]
        touched = np.union1d(np.unique(lighter.triangles[parts == part]), corners)
        carried = sparse.csr_array(
            (
                lighter.shares[whole].ravel(),
                (np.searchsorted(touched, corners).ravel(), np.repeat(np.arange(len(whole)), 3)),
            ),
            shape=(len(touched), len(whole)),
        )
        given = model.pose_right_hand_sides[rows]
        summed = (carried @ given.reshape(len(whole), -1)).reshape(-1, *given.shape[1:])
        vertices.append(touched)
        terms.append(summed)
        pointers.append(pointers[-1] + len(touched))
    return (
        np.array(pointers, dtype=model.incidence_pointers.dtype),
        np.concatenate(vertices).astype(model.incidence_vertices.dtype),
        np.concatenate(terms).astype(model.pose_right_hand_sides.dtype),
    )


def _moved(
    rows: SparseRows, lighter: LighterMesh, shapes: Shapes, fitted: LighterShapes
) -> SparseRows:
    """The rows over the vertices that remain; on bodies at rest each gives the same point.

    Weights go with their vertices, then change as little as possible, in the mean square, so that
    the sums of the mean body and of every direction of shape stay those of the whole ``shapes``.
    """
    pointers, indices, weights = [0], [], []
    for row in range(len(rows.names)):
        span = slice(rows.pointers[row], rows.pointers[row + 1])
        before, given = rows.indices[span], rows.weights[span]
        after, place = np.unique(lighter.corners[before], return_inverse=True)
        moved = np.bincount(place.ravel(), (given[:, None] * lighter.shares[before]).ravel())
        if len(after) > 1:
            kept = fitted[:, after]
            sums = np.concatenate(
                [kept.transpose(0, 2, 1).reshape(-1, len(after)), np.ones((1, len(after)))]
            )
            wanted = np.append(
                np.einsum("v,nvi->ni", given, shapes[:, before]).ravel(), given.sum()
            )
            moved = moved + np.linalg.lstsq(sums, wanted - sums @ moved, rcond=_RANK)[0]
        indices.append(after)
        weights.append(moved)
        pointers.append(pointers[-1] + len(after))
    return SparseRows(
        names=rows.names,
        pointers=np.array(pointers, dtype=rows.pointers.dtype),
        indices=np.concatenate(indices).astype(rows.indices.dtype),
        weights=np.concatenate(weights),
    )
