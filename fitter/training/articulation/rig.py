"""MakeHuman's default rig, posed by the 17 parts: the truth the articulation is trained on.

The paper learns its pose-dependent deformation from scans of people in many poses. Ours learns it
from MakeHuman's skeleton of 163 bones and its painted skinning weights. Every bone follows one
part, and takes a share of that part's turn or of the next one's: twist spreads along the forearm,
a bend along the spine, and a raised arm lifts the collar bone. A vertex is half linear, half
dual-quaternion skinned: the first sinks at bent elbows, the second bulges, their mean does neither.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse

from fitter.arrays import Pose, Rotations, Vertices
from fitter.body.model import global_rotations
from fitter.numerics.rotations import rotation_matrices, rotation_vectors
from fitter.training.articulation.parts import PART_NAMES, PART_PARENT
from fitter.training.articulation.rig_drives import BoneDrives, bone_drives, raised_shares


def blend_linear(
    skin: sparse.csr_array,
    rotations: Rotations,
    translations: Float[np.ndarray, "b 3"],
    rest: Vertices,
) -> Vertices:
    """Weighted mean of the bones' rigid motions of each vertex."""
    transforms = np.concatenate([rotations, translations[:, :, None]], axis=2).reshape(-1, 12)
    blended = (skin @ transforms).reshape(-1, 3, 4)
    return np.einsum("mij,mj->mi", blended[:, :, :3], rest) + blended[:, :, 3]


def blend_dual_quaternion(
    skin: sparse.csr_array,
    rotations: Rotations,
    translations: Float[np.ndarray, "b 3"],
    rest: Vertices,
) -> Vertices:
    """Dual-quaternion skinning (Kavan et al. 2007): the blend of rigid motions stays rigid."""
    real = _quaternions(rotations)
    pure = np.concatenate([np.zeros((len(real), 1)), translations], axis=1)
    dual = 0.5 * _product(pure, real)
    rows = np.repeat(np.arange(len(skin.indptr) - 1), np.diff(skin.indptr))
    # q and -q are one rotation; each vertex takes the signs that agree with its heaviest bone.
    pivot = real[_heaviest(skin)]
    sign = np.where(np.einsum("zi,zi->z", real[skin.indices], pivot[rows]) < 0.0, -1.0, 1.0)
    signed = sparse.csr_array((skin.data * sign, skin.indices, skin.indptr), shape=skin.shape)
    blended_real, blended_dual = signed @ real, signed @ dual
    norm = np.linalg.norm(blended_real, axis=1, keepdims=True)
    blended_real, blended_dual = blended_real / norm, blended_dual / norm
    conjugate = blended_real * np.array([1.0, -1.0, -1.0, -1.0])
    translation = 2.0 * _product(blended_dual, conjugate)[:, 1:]
    scalar, vector = blended_real[:, :1], blended_real[:, 1:]
    turned = rest + 2.0 * np.cross(vector, np.cross(vector, rest) + scalar * rest)
    return turned + translation


def blend_half_dual_quaternion(
    skin: sparse.csr_array,
    rotations: Rotations,
    translations: Float[np.ndarray, "b 3"],
    rest: Vertices,
) -> Vertices:
    """Mean of the two."""
    linear = blend_linear(skin, rotations, translations, rest)
    return 0.5 * (linear + blend_dual_quaternion(skin, rotations, translations, rest))


def _quaternions(rotations: Rotations) -> Float[np.ndarray, "b 4"]:
    vectors = rotation_vectors(rotations)
    angle = np.linalg.norm(vectors, axis=1)
    half_sine = 0.5 * np.sinc(0.5 * angle / np.pi)
    return np.concatenate([np.cos(angle / 2.0)[:, None], half_sine[:, None] * vectors], axis=1)


def _product(
    first: Float[np.ndarray, "k 4"], second: Float[np.ndarray, "k 4"]
) -> Float[np.ndarray, "k 4"]:
    scalar = first[:, 0] * second[:, 0] - np.einsum("ki,ki->k", first[:, 1:], second[:, 1:])
    vector = (
        first[:, :1] * second[:, 1:]
        + second[:, :1] * first[:, 1:]
        + np.cross(first[:, 1:], second[:, 1:])
    )
    return np.concatenate([scalar[:, None], vector], axis=1)


def _heaviest(skin: sparse.csr_array) -> np.ndarray:
    starts = skin.indptr[:-1]
    largest = np.maximum.reduceat(skin.data, starts)
    rows = np.repeat(np.arange(len(skin.indptr) - 1), np.diff(skin.indptr))
    at_largest = np.flatnonzero(skin.data == largest[rows])
    first = np.searchsorted(rows[at_largest], np.arange(len(skin.indptr) - 1))
    return skin.indices[at_largest[first]]


RIG_FILE = Path("rigs/standard/rig.default.json")
WEIGHTS_FILE = Path("rigs/standard/weights.default.json")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rig:
    """Bones in an order in which parents precede children; b of them, over v source vertices.

    Attributes
    ----------
    bone_names, bone_parent
        (b,) parent index, -1 for the root.
    head_rows
        (b, v) sparse: the centre about which a bone turns, as a mean of source vertices (helper
        cubes inside the body), so that joints follow the shape linearly.
    weights
        (v, b) sparse skinning weights, rows sum to one.
    drives
        Which part's turn moves which bone, and how far.
    """

    bone_names: tuple[str, ...]
    bone_parent: Integer[np.ndarray, " b"]
    head_rows: sparse.csr_array
    weights: sparse.csr_array
    drives: BoneDrives


def load_rig(assets: Path, groups: Mapping[str, Integer[np.ndarray, " _"]], count: int) -> Rig:
    """Read the rig beside the base mesh.

    Parameters
    ----------
    assets
        Folder of MakeHuman's data, with ``rigs/`` in it.
    groups
        Vertex ids of each named group of the base mesh; helper cubes are named ``joint-...``.
    count
        Number of vertices of the base mesh, v.
    """
    bones = json.loads((assets / RIG_FILE).read_text())
    names = _parents_first({name: str(bone["parent"]) for name, bone in bones.items()})
    index = {name: k for k, name in enumerate(names)}
    painted = json.loads((assets / WEIGHTS_FILE).read_text())["weights"]
    rows, columns, values = [], [], []
    for name in names:
        for vertex, weight in painted[name]:
            rows.append(vertex)
            columns.append(index[name])
            values.append(weight)
    return Rig(
        bone_names=names,
        bone_parent=np.array([index.get(str(bones[name]["parent"]), -1) for name in names]),
        head_rows=sparse.csr_array(
            np.stack([_head_row(bones[name]["head"], groups, count) for name in names])
        ),
        weights=sparse.csr_array((values, (rows, columns)), shape=(count, len(names))),
        drives=bone_drives(names),
    )


def bone_heads(rig: Rig, source_vertices: Vertices) -> Float[np.ndarray, "b 3"]:
    """Centres of the bones of a subject at rest, from all v source vertices."""
    return rig.head_rows @ source_vertices


def part_weights(rig: Rig, skin: sparse.csr_array) -> Float[np.ndarray, "m p"]:
    """Skinning weights summed over the bones of each part."""
    gather = np.zeros((len(rig.bone_names), len(PART_NAMES)))
    gather[np.arange(len(rig.bone_names)), rig.drives.part] = 1.0
    return skin @ gather


def bone_rotations(rig: Rig, pose: Pose) -> Float[np.ndarray, "b 3 3"]:
    """Rotation of every bone from rest to pose, body frame.

    Bone b of part p turns by R_parent(p) P(θ_p) P(θ_c): its own part's turn, taken in part, and a
    share of the turn of the part c beyond it.
    """
    drives = rig.drives
    parts = global_rotations(pose, PART_PARENT)
    parents = PART_PARENT[drives.part]
    base = np.where((parents < 0)[:, None, None], np.eye(3), parts[parents])
    own = partial_rotations(pose[drives.part], drives.axis, drives.swing, drives.twist)
    raised = raised_shares(pose[drives.beyond], drives.beyond_axis)
    beyond = partial_rotations(
        pose[drives.beyond],
        drives.beyond_axis,
        drives.beyond_swing + drives.raised_swing * raised,
        drives.beyond_twist,
    )
    whole = (drives.swing == 1.0) & (drives.twist == 1.0)
    own = np.where(whole[:, None, None], rotation_matrices(pose)[drives.part], own)
    return base @ own @ beyond


def posed_vertices(
    rig: Rig,
    skin: sparse.csr_array,
    rest: Vertices,
    heads: Float[np.ndarray, "b 3"],
    pose: Pose,
) -> Vertices:
    """Pose a body.

    Parameters
    ----------
    rig
        From :func:`load_rig`.
    skin
        (m, b) the rows of the rig's weights that belong to the body's vertices.
    rest
        (m, 3) the body at rest, body frame, metres.
    heads
        (b, 3) its bone centres, from :func:`bone_heads`.
    pose
        (p, 3) as in :class:`fitter.parameters.BodyParameters`.

    Returns
    -------
    (m, 3) in the body frame; the root bone's centre stays where it is.
    """
    rotations, translations = bone_motions(rig, heads, pose)
    return blend_half_dual_quaternion(skin, rotations, translations, rest)


def bone_motions(
    rig: Rig, heads: Float[np.ndarray, "b 3"], pose: Pose
) -> tuple[Float[np.ndarray, "b 3 3"], Float[np.ndarray, "b 3"]]:
    """Rigid motion x -> R x + t of every bone from rest to pose, body frame."""
    rotations = bone_rotations(rig, pose)
    return rotations, placed_heads(rig, heads, rotations) - np.einsum(
        "bij,bj->bi", rotations, heads
    )


def placed_heads(
    rig: Rig, heads: Float[np.ndarray, "b 3"], rotations: Rotations
) -> Float[np.ndarray, "b 3"]:
    """Places of the turned bones' centres, body frame; the root bone's stays."""
    placed = heads.copy()
    for bone, parent in enumerate(rig.bone_parent):
        if parent >= 0:
            placed[bone] = placed[parent] + rotations[parent] @ (heads[bone] - heads[parent])
    return placed


def _head_row(
    head: Mapping[str, object], groups: Mapping[str, Integer[np.ndarray, " _"]], count: int
) -> Float[np.ndarray, " v"]:
    strategy = head["strategy"]
    if strategy == "CUBE":
        vertices = groups[str(head["cube_name"])]
    elif strategy == "VERTEX":
        vertices = np.array([head["vertex_index"]])
    else:
        vertices = np.array(head["vertex_indices"])
    row = np.zeros(count)
    np.add.at(row, vertices, 1.0 / len(vertices))
    return row


def _parents_first(parents: Mapping[str, str]) -> tuple[str, ...]:
    ordered: list[str] = []
    waiting = list(parents)
    while waiting:
        ready = [name for name in waiting if parents[name] not in waiting]
        ordered.extend(ready)
        waiting = [name for name in waiting if name not in ready]
    return tuple(ordered)


def swing_and_twist(
    vectors: Float[np.ndarray, "k 3"], axes: Float[np.ndarray, "k 3"]
) -> tuple[Float[np.ndarray, "k 3"], Float[np.ndarray, " k"]]:
    """Split R = S T into a twist T about an axis, applied first, and a swing S across it.

    Returns
    -------
    swing
        (k, 3) rotation vectors of S, perpendicular to the axes.
    twist
        (k,) angles of T about the axes, radians, in (-π, π].
    """
    angle = np.linalg.norm(vectors, axis=1)
    half_sine = 0.5 * np.sinc(0.5 * angle / np.pi)
    twist = 2.0 * np.arctan2(half_sine * np.einsum("ki,ki->k", vectors, axes), np.cos(angle / 2.0))
    twist = np.where(twist > np.pi, twist - 2.0 * np.pi, twist)
    twist = np.where(twist <= -np.pi, twist + 2.0 * np.pi, twist)
    untwist = rotation_matrices(-twist[:, None] * axes)
    return rotation_vectors(rotation_matrices(vectors) @ untwist), twist


def partial_rotations(
    vectors: Float[np.ndarray, "k 3"],
    axes: Float[np.ndarray, "k 3"],
    swing_share: Float[np.ndarray, " k"],
    twist_share: Float[np.ndarray, " k"],
) -> Rotations:
    """Rotations S^swing_share T^twist_share."""
    swing, twist = swing_and_twist(vectors, axes)
    return rotation_matrices(swing_share[:, None] * swing) @ rotation_matrices(
        (twist_share * twist)[:, None] * axes
    )
