"""From registered bodies to a body model."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import islice

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse

from fitter.arrays import Triangles, Vertices
from fitter.body.model import BodyModel, SparseRows
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape
from fitter.numerics.meshes import gradient_operator, part_laplacians, triangle_areas
from fitter.training.articulation.joints import (
    fit_joint_regressor,
    regressed_joints,
    rest_joints_of,
)
from fitter.training.articulation.parts import (
    PART_NAMES,
    PART_PARENT,
    Parts,
    cut_into_parts,
    mirrored_part,
    part_index,
)
from fitter.training.articulation.pose_term import (
    PoseExample,
    PoseTerm,
    pose_feature_joints,
    train_pose_term,
)
from fitter.training.articulation.poses import canonical_pose, standing_pose, taught_poses
from fitter.training.articulation.rigged_bodies import RegisteredBodies
from fitter.training.makehuman.meshes import BaseMesh
from fitter.training.shapes.attribute_spaces import attribute_space
from fitter.training.shapes.decimation import lighter_mesh
from fitter.training.shapes.height_rotation import Attribute
from fitter.training.shapes.principal_shapes import principal_shapes, vertex_masses

SHAPE_COUNT = 20
"""n in the paper's experiments."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyMesh:
    """Everything but vertices that the bodies of a model share; fields as in the model."""

    triangles: Triangles
    parts: Parts
    joint_regressor: SparseRows
    landmarks: SparseRows
    uv: Float[np.ndarray, "u 2"]
    uv_triangles: Triangles
    mirror: Integer[np.ndarray, " m"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShapeSpace:
    """The whitened shape space that a pose-dependent term is learned in.

    Attributes
    ----------
    mean, basis
        (m, 3) and (n, m, 3), root joint at the origin, metres.
    coefficients
        (s, n) of the training subjects.
    laplacians
        L_p = G_pᵀ W_p G_p of each part on the mean.
    """

    mean: Vertices
    basis: Float[np.ndarray, "n m 3"]
    coefficients: Float[np.ndarray, "s n"]
    laplacians: list[sparse.csr_array]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TrainedModel:
    """A body model with the training subjects' coefficients in its shape space."""

    model: BodyModel
    coefficients: Float[np.ndarray, "s n"]


def assemble_body_model(
    bodies: RegisteredBodies,
    surface: BaseMesh,
    part_weights: Float[np.ndarray, "m p"],
    landmarks: SparseRows,
    *,
    header: Mapping[str, object],
    example_count: int,
    rng: np.random.Generator,
) -> TrainedModel:
    """Learn shape space, articulation and pose-dependent term.

    Parameters
    ----------
    bodies
        The training subjects.
    surface
        The mesh they share.
    part_weights
        Skinning weights summed over each part.
    landmarks
        Rows by name; height needs ``crown``, ``sole_left`` and ``sole_right``.
    header
        Provenance, with the gender.
    example_count
        Posed bodies the pose-dependent term learns from; none leaves it zero.
    rng
        Draws their poses.
    """
    mirror_joint = np.array([part_index(mirrored_part(name)) for name in PART_NAMES])
    mesh = BodyMesh(
        triangles=surface.triangles,
        parts=cut_into_parts(surface.triangles, part_weights),
        joint_regressor=fit_joint_regressor(
            bodies.rest, bodies.joints, surface.mirror, mirror_joint
        ),
        landmarks=landmarks,
        uv=surface.uv,
        uv_triangles=surface.uv_triangles,
        mirror=surface.mirror,
    )

    feature_joints = pose_feature_joints()

    def pose_term(space: ShapeSpace) -> PoseTerm:
        return train_pose_term(
            pose_examples(bodies, space.coefficients, surface.mirror, example_count, rng),
            space.laplacians,
            mesh.parts,
            feature_joints,
            SHAPE_COUNT,
        )

    return learn_body_model(
        bodies.rest,
        mesh,
        header=header,
        shape_count=SHAPE_COUNT,
        feature_joints=feature_joints,
        pose_term=pose_term,
        measurements=bodies.measurements,
    )


def learn_body_model(
    rest: Float[np.ndarray, "s m 3"],
    mesh: BodyMesh,
    *,
    header: Mapping[str, object],
    shape_count: int,
    feature_joints: Integer[np.ndarray, "p q"],
    pose_term: Callable[[ShapeSpace], PoseTerm],
    measurements: Float[np.ndarray, "s k"] | None = None,
) -> TrainedModel:
    """Learn the shape space of bodies at rest; the pose-dependent term is asked for in it.

    ``feature_joints`` are those whose turns drive the term, as in the model; ``measurements`` those
    of :class:`RegisteredBodies`.
    """
    masses = vertex_masses(rest.mean(axis=0, dtype=np.float64), mesh.triangles)
    shapes = principal_shapes(rest, masses, shape_count, measurements)
    regressor, parts = mesh.joint_regressor, mesh.parts
    mean = _as_stored(_rooted(shapes.mean[None], regressor)[0])
    areas = _as_stored(triangle_areas(mean, mesh.triangles))
    space = ShapeSpace(
        mean=mean,
        basis=_rooted(shapes.axes, regressor),
        coefficients=shapes.coefficients,
        laplacians=part_laplacians(
            gradient_operator(mean, mesh.triangles), areas, parts.part_of_triangle, len(PART_NAMES)
        ),
    )
    term = pose_term(space)
    joints = rest_joints_of(regressor, mean)
    model = BodyModel(
        gender=str(header["gender"]),
        header=header,
        triangles=mesh.triangles,
        mean_vertices=mean,
        shape_basis=space.basis,
        part_names=PART_NAMES,
        part_parent=PART_PARENT,
        part_of_triangle=parts.part_of_triangle,
        triangle_weights=areas,
        joint_regressor=regressor,
        skinning_parts=parts.skinning_parts,
        skinning_weights=parts.skinning_weights,
        pose_feature_joints=feature_joints,
        pose_feature_strengths=term.strengths,
        incidence_pointers=parts.incidence_pointers,
        incidence_vertices=parts.incidence_vertices,
        pose_right_hand_sides=_as_stored(term.right_hand_sides),
        landmarks=mesh.landmarks,
        uv=mesh.uv,
        uv_triangles=mesh.uv_triangles,
        mirror=mesh.mirror,
        lighter=lighter_mesh(mean, mesh.triangles, (mesh.landmarks, regressor)),
        canonical_pose=canonical_pose(joints),
        standing_pose=standing_pose(joints),
    )
    return with_height_axis(model, shapes.coefficients)


def with_height_axis(model: BodyModel, coefficients: Float[np.ndarray, "s n"]) -> TrainedModel:
    """The model in the basis whose first axis alone carries height (section 4).

    ``coefficients`` are the training subjects' in the model's own, whitened, shape space.
    """
    turned = attribute_space(model, height_attribute(model), coefficients)
    return TrainedModel(model=turned.model, coefficients=coefficients @ turned.turn)


def height_attribute(model: BodyModel) -> Attribute:
    """H(β): stature of the body reconstructed in the standing pose, metres."""
    return partial(height_of_shape, ScapeEvaluator(model))


def pose_examples(
    bodies: RegisteredBodies,
    coefficients: Float[np.ndarray, "s n"],
    mirror: Integer[np.ndarray, " m"],
    count: int,
    rng: np.random.Generator,
) -> Iterator[PoseExample]:
    """Posed bodies with their shape coefficients; subjects and taught poses in turn.

    Every body is followed by its mirror image, so that both sides are taught alike.
    """
    for k, pose in enumerate(islice(taught_poses(rng), (count + 1) // 2)):
        subject = k % len(bodies.rest)
        example = PoseExample(
            rest=bodies.rest[subject].astype(np.float64),
            posed=bodies.posed(subject, pose),
            pose=pose,
            shape=coefficients[subject],
        )
        yield example
        yield mirrored_example(example, mirror)


def mirrored_example(example: PoseExample, mirror: Integer[np.ndarray, " m"]) -> PoseExample:
    """The mirror image of a posed body; its shape is taken to be as symmetric as the mesh."""
    flip = np.array([-1.0, 1.0, 1.0])
    turned = np.array([1.0, -1.0, -1.0])
    parts = [part_index(mirrored_part(name)) for name in PART_NAMES]
    return PoseExample(
        rest=flip * example.rest[mirror],
        posed=flip * example.posed[mirror],
        pose=turned * example.pose[parts],
        shape=example.shape,
    )


def model_arrays(model: BodyModel) -> dict[str, np.ndarray]:
    """The fields of a model file (see :mod:`fitter.body.storage`), most in single precision."""
    integers = {
        "triangles": model.triangles,
        "part_parent": model.part_parent,
        "part_of_triangle": model.part_of_triangle,
        "joint_pointers": model.joint_regressor.pointers,
        "joint_indices": model.joint_regressor.indices,
        "skinning_parts": model.skinning_parts,
        "pose_feature_joints": model.pose_feature_joints,
        "incidence_pointers": model.incidence_pointers,
        "incidence_vertices": model.incidence_vertices,
        "landmark_pointers": model.landmarks.pointers,
        "landmark_indices": model.landmarks.indices,
        "uv_triangles": model.uv_triangles,
        "mirror": model.mirror,
        "lighter_kept": model.lighter.kept,
        "lighter_triangles": model.lighter.triangles,
        "lighter_origin": model.lighter.origin,
        "lighter_corners": model.lighter.corners,
    }
    floats = {
        "mean_vertices": model.mean_vertices,
        "shape_basis": model.shape_basis,
        "triangle_weights": model.triangle_weights,
        "pose_feature_strengths": model.pose_feature_strengths,
        "joint_weights": model.joint_regressor.weights,
        "skinning_weights": model.skinning_weights,
        "pose_right_hand_sides": model.pose_right_hand_sides,
        "landmark_weights": model.landmarks.weights,
        "uv": model.uv,
        "canonical_pose": model.canonical_pose,
        "standing_pose": model.standing_pose,
    }
    return (
        {name: np.asarray(array, dtype=np.int32) for name, array in integers.items()}
        | {name: np.asarray(array, dtype=np.float32) for name, array in floats.items()}
        | {"lighter_shares": model.lighter.shares}
    )


def _rooted(
    meshes: Float[np.ndarray, "k m 3"], regressor: SparseRows
) -> Float[np.ndarray, "k m 3"]:
    """Meshes, or displacements, moved so that the root joint lies at the origin."""
    return meshes - regressed_joints(regressor, meshes)[:, :1]


def _as_stored(array: np.ndarray) -> np.ndarray:
    """Rounded to what the file keeps, so that training sees what the fit will."""
    return array.astype(np.float32).astype(np.float64)
