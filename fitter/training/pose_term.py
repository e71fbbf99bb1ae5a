"""The pose-dependent deformation E(θ), learned by ridge regression in each part's frame.

SCAPE asks of every triangle t of part p the deformation gradient R_p [D_t(β) + E_t(θ)]. E is linear
in the features (R_joint - I) of the joints next to the part: a sine and a cosine of each angle, so
that a bend's bulge may grow with the bend or with its square, while a body at rest is left alone.

Only G_pᵀ W_p E_p ever enters the least squares (see :mod:`fitter.body.scape`), so that product is
regressed itself, in place of the E_t: three numbers an incidence instead of six a triangle, the
same regression because it is linear.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse

from fitter.arrays import Pose, Vertices
from fitter.body.skeleton import global_rotations
from fitter.numerics.rotations import rotation_matrices
from fitter.training.part_tree import PART_NAMES, PART_PARENT, part_index, side_and_limb
from fitter.training.parts import Parts

RIDGE = 1e-3
"""Relative to the mean square of the features. Held-out error is flat from 1e-4 to 1e-2."""

_JOINTS: Mapping[str, tuple[str, ...]] = {
    "pelvis": ("spine", "left_thigh", "right_thigh", "chest"),
    "spine": ("spine", "chest", "left_thigh", "right_thigh"),
    "chest": ("chest", "left_upper_arm", "right_upper_arm", "neck"),
    "neck": ("neck", "head", "left_upper_arm", "right_upper_arm"),
    "head": ("head", "neck"),
    "upper_arm": ("upper_arm", "forearm"),
    "forearm": ("forearm", "hand"),
    "hand": ("hand",),
    "thigh": ("thigh", "shin"),
    "shin": ("shin", "foot"),
    "foot": ("foot",),
}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PoseExample:
    """One body at rest and posed, body frame, metres; translations are free."""

    rest: Vertices
    posed: Vertices
    pose: Pose


def pose_feature_joints() -> Integer[np.ndarray, "p q"]:
    """Joints that drive each part's term, -1 where unused."""
    width = max(map(len, _JOINTS.values()))
    table = np.full((len(PART_NAMES), width), -1, dtype=np.int32)
    for part, name in enumerate(PART_NAMES):
        side, limb = side_and_limb(name)
        for column, joint in enumerate(_JOINTS[limb]):
            table[part, column] = part_index(joint if joint in PART_NAMES else f"{side}_{joint}")
    return table


def features(pose: Pose, joints: Integer[np.ndarray, "p q"]) -> Float[np.ndarray, "p nine_q"]:
    """(R_joint - I) per part, flattened joint by joint and row by row, zero where unused."""
    difference = rotation_matrices(pose) - np.eye(3)
    return np.where((joints >= 0)[:, :, None, None], difference[joints], 0.0).reshape(
        len(joints), -1
    )


def train_pose_term(
    examples: Iterable[PoseExample],
    laplacians: list[sparse.csr_array],
    parts: Parts,
    joints: Integer[np.ndarray, "p q"],
    *,
    ridge: float = RIDGE,
) -> Float[np.ndarray, "i 3 nine_q"]:
    """Regress the pose-dependent right-hand sides.

    Parameters
    ----------
    examples
        Bodies in many poses; read once.
    laplacians
        L_p = G_pᵀ W_p G_p of each part on the rest mean mesh.
    parts
        Which vertices each part touches.
    joints
        From :func:`pose_feature_joints`.
    ridge
        Relative to the mean square of a part's features.

    Returns
    -------
    P with G_pᵀ W_p E_p(θ) = P φ_p(θ), zero in the columns of unused features.
    """
    pointers, vertices = parts.incidence_pointers, parts.incidence_vertices
    spans = [slice(pointers[p], pointers[p + 1]) for p in range(len(laplacians))]
    restricted = [
        laplacian[vertices[span]] for laplacian, span in zip(laplacians, spans, strict=True)
    ]
    width = joints.shape[1] * 9
    squares = np.zeros((len(laplacians), width, width))
    products = np.zeros((width, len(vertices), 3))
    for example in examples:
        phi = features(example.pose, joints)
        rotations = global_rotations(example.pose, PART_PARENT)
        for part, (laplacian, span) in enumerate(zip(restricted, spans, strict=True)):
            target = laplacian @ example.posed @ rotations[part] - laplacian @ example.rest
            squares[part] += np.outer(phi[part], phi[part])
            used = 9 * int(np.count_nonzero(joints[part] >= 0))
            products[:used, span] += phi[part, :used, None, None] * target
    result = np.zeros((len(vertices), 3, width))
    for part, span in enumerate(spans):
        used = 9 * int(np.count_nonzero(joints[part] >= 0))
        square = squares[part, :used, :used]
        # Joints that no example turns leave nothing to learn: any penalty gives zero there.
        penalty = ridge * np.trace(square) / used or 1.0
        right = products[:used, span].reshape(used, -1)
        solved = np.linalg.solve(square + penalty * np.eye(used), right)
        result[span, :, :used] = solved.reshape(used, -1, 3).transpose(1, 2, 0)
    return result
