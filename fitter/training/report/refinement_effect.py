"""What changes of a body's measurements and looks if every edge of its mesh is halved."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Integer
from scipy.spatial import KDTree

from fitter.arrays import GreyImage, Points2D, Shape, Triangles, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES, ScapeEvaluator
from fitter.body.shape_space import standing_vertices
from fitter.export.views import turned_about_vertical
from fitter.measurement.anthropometry import measurement_values, measuring_body
from fitter.measurement.definitions import Girth, Mass
from fitter.numerics.mesh_topology import MeshTopology, mesh_topology
from fitter.numerics.normals import summed_cross_products
from fitter.parameters import BodyParameters
from fitter.render.camera import Camera
from fitter.render.contours import model_edges
from fitter.render.interpolation import shade_image
from fitter.render.rasterizer import Rendering, render
from fitter.training.articulation.parts import cut_into_parts
from fitter.training.report.body_regions import triangle_regions, vertex_regions
from fitter.training.shapes.surface import triangle_areas

COARSE_REGIONS = ("trunk", "arms", "legs")
VIEWS_DEGREES = (0.0, 45.0, 90.0)
RANDOM_BODIES = 4
_SEED = 20090929

DISTANCE_M = 3.0
PX_PER_M = 800.0
"""Of the compared pictures, at the body: twice as fine as a fit's working picture of a person."""

OUTLINE_STEP_PX = 0.1
TO_LIGHT = np.array([-0.55, -0.52, -0.65])
"""Unit direction toward the light, camera frame."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RefinementEffect:
    """What halving every edge changes, over the mean body and some random ones.

    Stature and all lengths between landmarks stay: no vertex that was there moves.

    Attributes
    ----------
    girths_cm
        Mean change by measurement.
    weight_kg
        Mean change.
    outline_mm
        Root mean square distance of the two outlines along trunk, arms and legs, over all views.
    shading
        Root mean square change of the Lambertian term, of a full range of one, at pixels where both
        pictures show trunk, arms or legs; normals are interpolated over triangles in both.
    """

    girths_cm: Mapping[str, float]
    weight_kg: float
    outline_mm: float
    shading: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Fine:
    """The refined mesh's connectivity."""

    edges: Integer[np.ndarray, "e 2"]
    triangles: Triangles
    topology: MeshTopology
    coarse_topology: MeshTopology


def refinement_effect(model: BodyModel) -> RefinementEffect:
    """Compare bodies with themselves on a smooth mesh four times as fine."""
    evaluator = ScapeEvaluator(model)
    fine = _fine(model)
    rng = np.random.default_rng(_SEED)
    shapes = [
        np.zeros(len(model.shape_basis)),
        *rng.normal(size=(RANDOM_BODIES, len(model.shape_basis))),
    ]
    body = measuring_body(model, evaluator)
    coarse = np.stack([measurement_values(body, shape) for shape in shapes])
    changes = (_measured_finely(model, evaluator, fine, shapes) - coarse).mean(axis=0)
    seen = [
        _seen_changes(model, fine, standing_vertices(evaluator, shape), degrees)
        for shape in shapes
        for degrees in VIEWS_DEGREES
    ]
    by_definition = list(zip(body.definitions, changes.tolist(), strict=True))
    (weight_kg,) = (change for definition, change in by_definition if isinstance(definition, Mass))
    return RefinementEffect(
        girths_cm={d.about.name: change for d, change in by_definition if isinstance(d, Girth)},
        weight_kg=weight_kg,
        outline_mm=1000.0 / PX_PER_M * _root_mean_square(np.concatenate([s[0] for s in seen])),
        shading=_root_mean_square(np.concatenate([s[1] for s in seen])),
    )


def _fine(model: BodyModel) -> _Fine:
    count = len(model.mean_vertices)
    edges = halved_edges(model.triangles, count)
    triangles = refined_triangles(model.triangles, count).astype(np.int32)
    return _Fine(
        edges=edges,
        triangles=triangles,
        topology=mesh_topology(triangles, vertex_count=count + len(edges)),
        coarse_topology=mesh_topology(model.triangles, vertex_count=count),
    )


def _measured_finely(
    model: BodyModel, evaluator: ScapeEvaluator, fine: _Fine, shapes: Sequence[Shape]
) -> Float[np.ndarray, "s k"]:
    """Measurements of bodies refined in the canonical pose.

    The refined bodies become the shape axes of a model that rests in that pose, so that they are
    measured as any model's are; heights, taken in another pose, mean nothing there, nor do its
    texels and its mirror.
    """
    canonical = [
        evaluator.body_frame_vertices(
            BodyParameters(pose=model.canonical_pose, translation=np.zeros(3), shape=shape)
        )
        for shape in shapes
    ]
    refined = np.stack([smooth_refinement(c, model.triangles, fine.edges) for c in canonical])
    weights = np.zeros((len(model.mean_vertices), len(model.part_names)))
    np.put_along_axis(weights, model.skinning_parts, model.skinning_weights, axis=1)
    parts = cut_into_parts(fine.triangles, flat_refinement(weights, fine.edges))
    still = np.zeros_like(model.canonical_pose)
    unused = -np.ones((len(model.part_names), 1), dtype=np.int32)
    at_rest = replace(
        model,
        triangles=fine.triangles,
        mean_vertices=refined[0],
        shape_basis=refined - refined[0],
        part_of_triangle=parts.part_of_triangle,
        triangle_weights=triangle_areas(refined[0], fine.triangles),
        skinning_parts=parts.skinning_parts,
        skinning_weights=parts.skinning_weights,
        pose_feature_joints=unused,
        pose_feature_strengths=np.zeros((len(model.part_names), 9, len(shapes))),
        incidence_pointers=parts.incidence_pointers,
        incidence_vertices=parts.incidence_vertices,
        pose_right_hand_sides=np.zeros((len(parts.incidence_vertices), 3, 9)),
        uv_triangles=np.zeros_like(fine.triangles),
        mirror=np.arange(len(refined[0]), dtype=np.int32),
        canonical_pose=still,
        standing_pose=still,
    )
    body = measuring_body(at_rest, ScapeEvaluator(at_rest))
    return np.stack([measurement_values(body, axis) for axis in np.eye(len(shapes))])


def _seen_changes(
    model: BodyModel, fine: _Fine, standing: Vertices, degrees: float
) -> tuple[np.ndarray, np.ndarray]:
    """Distances of outlines, pixels, and differences of shading, from one side."""
    there = np.array([0.0, 0.0, DISTANCE_M])
    coarse_body = turned_about_vertical(standing * CAMERA_AXES, np.zeros(3), degrees) + there
    fine_body = smooth_refinement(coarse_body, model.triangles, fine.edges)
    camera = _camera(coarse_body)
    coarse = render(coarse_body, model.triangles, camera)
    refined = render(fine_body, fine.triangles, camera)
    chosen = np.any([triangle_regions(model)[name] for name in COARSE_REGIONS], axis=0)
    vertices = np.any([vertex_regions(model)[name] for name in COARSE_REGIONS], axis=0)
    own = _outline(coarse, fine.coarse_topology, vertices)
    other = _outline(refined, fine.topology, None)
    distances = np.asarray(KDTree(other).query(own)[0])
    both = (coarse.face_ids >= 0) & (refined.face_ids >= 0)
    both &= chosen[np.maximum(coarse.face_ids, 0)] & chosen[np.maximum(refined.face_ids, 0) // 4]
    shades = [_lambertian(rendering)[both] for rendering in (coarse, refined)]
    return distances, shades[1] - shades[0]


def _camera(vertices: Vertices) -> Camera:
    """A camera whose picture holds the body with a margin."""
    focal = PX_PER_M * DISTANCE_M
    flat = focal * vertices[:, :2] / vertices[:, 2:]
    low, high = flat.min(axis=0) - 8.0, flat.max(axis=0) + 8.0
    width, height = np.ceil(high - low).astype(int).tolist()
    return Camera(
        focal_length_px=focal,
        centre_x=float(-low[0]),
        centre_y=float(-low[1]),
        width=width,
        height=height,
    )


def _outline(
    rendering: Rendering, topology: MeshTopology, members: Bool[np.ndarray, " m"] | None
) -> Points2D:
    """Points along the visible outline; with ``members`` only along edges between such vertices."""
    found = model_edges(rendering, topology)
    used = found.visible & found.is_outer_silhouette
    if members is not None:
        used &= members[found.edges].all(axis=1)
    start, end = found.endpoints[used].transpose(1, 0, 2)
    counts = np.maximum(1, np.linalg.norm(end - start, axis=1) / OUTLINE_STEP_PX).astype(int)
    return np.concatenate(
        [
            one + (np.arange(count)[:, None] + 0.5) / count * (other - one)
            for one, other, count in zip(start, end, counts.tolist(), strict=True)
        ]
    )


def _lambertian(rendering: Rendering) -> GreyImage:
    return shade_image(rendering, np.clip(rendering.vertex_normals @ TO_LIGHT, 0.0, 1.0))


def _root_mean_square(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def halved_edges(triangles: Triangles, vertex_count: int) -> Integer[np.ndarray, "e 2"]:
    """The edges of a closed mesh, in the order of the vertices that halve them."""
    return mesh_topology(triangles, vertex_count=vertex_count).edges


def refined_triangles(triangles: Triangles, vertex_count: int) -> Integer[np.ndarray, "4*f 3"]:
    """Each triangle cut into four, kept together and in order; new vertices after the old ones."""
    edges = halved_edges(triangles, vertex_count)
    keys = edges[:, 0].astype(np.int64) * vertex_count + edges[:, 1]
    pairs = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2), axis=2)
    wanted = pairs[..., 0].astype(np.int64) * vertex_count + pairs[..., 1]
    # middles[:, k] halves the edge from corner k to corner k + 1.
    middles = vertex_count + np.searchsorted(keys, wanted)
    a, b, c = triangles.T
    ab, bc, ca = middles.T
    four = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.stack([np.stack(corners, axis=1) for corners in four], axis=1).reshape(-1, 3)


def flat_refinement(
    values: Float[np.ndarray, "m d"], edges: Integer[np.ndarray, "e 2"]
) -> Float[np.ndarray, "m+e d"]:
    """The same surface, or values on it, with more vertices: edges halved where they run."""
    return np.concatenate([values, values[edges].mean(axis=1)])


def smooth_refinement(
    vertices: Vertices, triangles: Triangles, edges: Integer[np.ndarray, "e 2"]
) -> Float[np.ndarray, "m+e 3"]:
    """Edges halved on the smooth curve that leaves both ends along their tangent planes.

    The cubic Hermite curve from a to b, whose tangents are b - a laid into the planes of the vertex
    normals, has its middle at (a + b) / 2 + (t_a - t_b) / 8. Old vertices stay: unlike Loop's
    scheme this one interpolates, and the change is what flat triangles leave out, not a shrinking.
    """
    normals = summed_cross_products(vertices, triangles)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    start, end = edges.T
    along = vertices[end] - vertices[start]
    tangent_change = -normals[start] * np.einsum("ei,ei->e", normals[start], along)[:, None]
    tangent_change += normals[end] * np.einsum("ei,ei->e", normals[end], along)[:, None]
    return np.concatenate([vertices, vertices[edges].mean(axis=1) + tangent_change / 8.0])
