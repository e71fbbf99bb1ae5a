"""Flesh that gives way at a bent joint comes out beside it: posed bodies that keep their volume.

Skinned alone, MakeHuman's bodies lose 3 % of their volume where the spine bends forward, 2 % at a
flexed hip, and gain as much at a raised arm. Flesh does neither. Here the skin round a joint moves
along its normal as far as makes up for what that joint, bent alone, takes or adds::

    x_i += Σ_j λ_j s_ji n_i,        λ_j Σ_i A_i s_ji = -ΔV_j(θ_j)

with posed normals n_i and areas A_i. The pattern s_ji of joint j is 4 f (1 - f), where f is the
share of the joint's turn that skinning gives to vertex i: largest half way through the bend, none
where the body stays rigid. Joint by joint, because each is then a function of its own angles, which
the pose-dependent term of SCAPE can learn.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse

from fitter.arrays import Pose, Triangles, Vertices
from fitter.numerics.meshes import vertex_areas
from fitter.numerics.normals import summed_cross_products
from fitter.training.articulation.parts import PART_NAMES, PART_PARENT
from fitter.training.articulation.rig import Rig, bone_motions
from fitter.training.articulation.skinning import blend_half_dual_quaternion

FRONT_DEPTH_M = 0.06
"""The spine's joints lie near the back, so it is belly and chest that a bend squeezes: the pattern
of these joints grows from none at their depth to all of itself this far before it."""

_SPINAL = ("spine", "chest")

_RIGID_ENDS = ("head", "hand", "foot")
"""Parts whose joints change the volume by less than 0.1 %; they are left alone."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointSurroundings:
    """What a joint deforms when it alone turns.

    Attributes
    ----------
    part
        The part that turns.
    carrier
        A bone that takes the whole turn.
    blended
        (k,) vertices that follow it in part.
    skin
        (k, b) their skinning weights.
    bent
        (g, 3) triangles that touch them or join what is carried to what is not.
    carried_triangles
        (h, 3) triangles that the turn carries along as they are.
    carried
        (c,) vertices carried along whole.
    share
        (m,) f, the share of the turn that skinning gives to each vertex.
    """

    part: int
    carrier: int
    blended: Integer[np.ndarray, " k"]
    skin: sparse.csr_array
    bent: Integer[np.ndarray, "g 3"]
    carried_triangles: Integer[np.ndarray, "h 3"]
    carried: Integer[np.ndarray, " c"]
    share: Float[np.ndarray, " m"]


def joint_surroundings(
    rig: Rig, skin: sparse.csr_array, triangles: Triangles
) -> tuple[JointSurroundings, ...]:
    """The surroundings of every joint that changes the volume of bodies."""
    return tuple(
        _surroundings(rig, skin, triangles, part)
        for part, name in enumerate(PART_NAMES)
        if PART_PARENT[part] >= 0 and not name.endswith(_RIGID_ENDS)
    )


def with_volume_kept(
    rig: Rig,
    surroundings: tuple[JointSurroundings, ...],
    triangles: Triangles,
    *,
    rest: Vertices,
    heads: Float[np.ndarray, "b 3"],
    joints: Float[np.ndarray, "p 3"],
    pose: Pose,
    posed: Vertices,
) -> Vertices:
    """A skinned body with the volume it has at rest, but for what joints do to one another.

    Parameters
    ----------
    rig, surroundings, triangles
        The rig, from :func:`joint_surroundings`, and the closed mesh.
    rest, heads, joints
        The body, its bone centres and its joints at rest, body frame, metres.
    pose, posed
        The pose, and the body skinned in it.
    """
    areas = vertex_areas(posed, triangles)
    outward = np.zeros(len(rest))
    for about in surroundings:
        turn = pose[about.part]
        if turn.any():
            alone = np.zeros_like(pose)
            alone[about.part] = turn
            pattern = _pattern(about, rest, joints)
            change = volume_change(rig, about, rest, heads, alone)
            outward -= change / (areas @ pattern) * pattern
    sums = summed_cross_products(posed, triangles)
    normals = sums / np.linalg.norm(sums, axis=1, keepdims=True)
    return posed + outward[:, None] * normals


def volume_change(
    rig: Rig,
    about: JointSurroundings,
    rest: Vertices,
    heads: Float[np.ndarray, "b 3"],
    alone: Pose,
) -> float:
    """Volume gained by skinning when one joint alone turns, cubic metres.

    Only the joint's surroundings are skinned. What moves rigidly, x -> R x + t, changes its part of
    the volume integral by t . R a / 6, where a sums the cross products of its triangles' edges.
    """
    rotations, translations = bone_motions(rig, heads, alone)
    rotation, translation = rotations[about.carrier], translations[about.carrier]
    posed = rest.copy()
    posed[about.carried] = rest[about.carried] @ rotation.T + translation
    posed[about.blended] = blend_half_dual_quaternion(
        about.skin, rotations, translations, rest[about.blended]
    )
    a, b, c = (rest[about.carried_triangles[:, k]] for k in range(3))
    crosses = np.cross(b - a, c - a).sum(axis=0)
    bent = _signed_volume(posed, about.bent) - _signed_volume(rest, about.bent)
    return bent + float(translation @ rotation @ crosses) / 6.0


def _surroundings(
    rig: Rig, skin: sparse.csr_array, triangles: Triangles, part: int
) -> JointSurroundings:
    drives = rig.drives
    beyond_it = _descendants(part)[drives.part]
    own = drives.part == part
    fed_back = (drives.beyond == part) & ~own
    swing = np.where(own, drives.swing, np.where(fed_back, drives.beyond_swing, 0.0))
    twist = np.where(own, drives.twist, np.where(fed_back, drives.beyond_twist, 0.0))
    swing, twist = np.where(beyond_it, 1.0, swing), np.where(beyond_it, 1.0, twist)
    whole, none = (swing == 1.0) & (twist == 1.0), (swing == 0.0) & (twist == 0.0)
    by_whole, by_none = skin @ whole.astype(float), skin @ none.astype(float)
    carried, still = by_whole > 1.0 - 1e-9, by_none > 1.0 - 1e-9
    blended = np.flatnonzero(~carried & ~still)
    all_carried = carried[triangles].all(axis=1)
    bent = ~all_carried & ~still[triangles].all(axis=1)
    return JointSurroundings(
        part=part,
        carrier=int(np.flatnonzero(whole)[0]),
        blended=blended,
        skin=sparse.csr_array(skin[blended]),
        bent=np.ascontiguousarray(triangles[bent]),
        carried_triangles=triangles[all_carried],
        carried=np.flatnonzero(carried),
        share=np.asarray(skin @ swing),
    )


def _descendants(part: int) -> np.ndarray:
    """(p,) bool: the parts beyond a part."""
    beyond = np.zeros(len(PART_NAMES), dtype=bool)
    for other in range(len(PART_NAMES)):
        parent = PART_PARENT[other]
        beyond[other] = parent >= 0 and (parent == part or beyond[parent])
    return beyond


def _pattern(
    about: JointSurroundings, rest: Vertices, joints: Float[np.ndarray, "p 3"]
) -> Float[np.ndarray, " m"]:
    pattern = 4.0 * about.share * (1.0 - about.share)
    if PART_NAMES[about.part] in _SPINAL:
        before = (rest[:, 2] - joints[about.part, 2]) / FRONT_DEPTH_M
        pattern = pattern * np.clip(before, 0.0, 1.0)
    return pattern


def _signed_volume(vertices: Vertices, triangles: Triangles) -> float:
    """Volume between triangles and the frame's origin; that of a mesh if they close it."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float(np.einsum("fi,fi->", a, np.cross(b, c))) / 6.0
