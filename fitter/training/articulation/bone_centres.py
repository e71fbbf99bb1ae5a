"""Centres about which the bones of the rig turn, told by the skin around them.

MakeHuman marks the centre of a bone by a small helper cube inside the body. Its targets move the
cubes more or less as they move the skin: with age, ancestry, weight and muscle a hip's cube strays
from where its surroundings go by 6 to 9 mm (mean over surveyed subjects), the cubes of the spine by
7 to 24 mm. Nothing on the surface tells how far, so no model of the surface could learn how such a
body bends. Here a bone turns about the weighted mean of the skin around it that comes nearest to
its cube over bodies drawn from all shapes: as in section 3.1, where the paper has the lengths of
limbs linear in the vertices.

Shoulder, elbow, wrist, hip, knee and ankle as people click them lie there too. Fitted at rest
alone, their weights put a bent hip 22 mm from its centre on average: the skin in front folds, the
skin behind stretches. Fitted to subjects at rest and in random poses alike, they choose skin that
does neither.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse

from fitter.arrays import Vertices
from fitter.body.model import SparseRows
from fitter.training.articulation.joints import convex_weights, ring_about
from fitter.training.articulation.poses import random_pose
from fitter.training.articulation.rig import Rig, bone_heads, bone_rotations, placed_heads
from fitter.training.articulation.rigged_bodies import RegisteredBodies, RiggedMesh
from fitter.training.makehuman.body_space import BodySpace, Traits, source_vertices
from fitter.training.makehuman.landmarks import Row, with_rows
from fitter.training.makehuman.meshes import BaseMesh
from fitter.training.makehuman.phenotypes import FACE_CHANGES, YOUNG_AGE

BONES: Mapping[str, str] = {
    "shoulder": "upperarm01.L",
    "elbow": "lowerarm01.L",
    "wrist": "wrist.L",
    "hip": "upperleg01.L",
    "knee": "lowerleg01.L",
    "ankle": "foot.L",
}
"""The bone about whose head the joint turns."""

EXAMPLES = 240
"""Subjects at rest, and as many posed; on others the error is the same to a tenth."""

CANDIDATES = 400
"""Vertices a point may be a sum of, the nearest to it."""

RIDGE = 3e-4
"""Square metres, on the weights. With a tenth of it a hip comes 1 mm nearer, with weights that sum
to 12 in absolute value in place of 4 and pass on what the model's mesh has wrong."""


def with_inner_points(
    landmarks: SparseRows,
    mesh: RiggedMesh,
    sources: Float[np.ndarray, "s v 3"],
    bodies: RegisteredBodies,
    rng: np.random.Generator,
) -> SparseRows:
    """The landmarks with their inner points fitted to one gender's subjects.

    Parameters
    ----------
    landmarks
        Of the mesh, with all names.
    mesh
        The mesh with the rig that poses it.
    sources, bodies
        All source vertices of the subjects at rest, and the same subjects as registered bodies.
    rng
        Draws their poses.
    """
    # Of few subjects, some are taken more than once, in poses of their own.
    chosen = np.linspace(0, len(sources) - 1, EXAMPLES).astype(int)
    heads = np.stack([bone_heads(mesh.rig, sources[k].astype(np.float64)) for k in chosen])
    poses = [random_pose(rng) for _ in chosen]
    posed = np.stack(
        [
            bodies.posed(int(k), pose).astype(np.float32)
            for k, pose in zip(chosen, poses, strict=True)
        ]
    )
    posed_heads = np.stack(
        [
            placed_heads(mesh.rig, each, bone_rotations(mesh.rig, pose))
            for each, pose in zip(heads, poses, strict=True)
        ]
    )
    rest = bodies.rest[chosen]
    rows: dict[str, Row] = {}
    for name, bone_name in BONES.items():
        bone = mesh.rig.bone_names.index(bone_name)
        middle = heads[:, bone].mean(axis=0)
        members = nearest(rest.mean(axis=0), middle, CANDIDATES)
        weights = inner_weights(
            [rest[:, members], posed[:, members]], [heads[:, bone], posed_heads[:, bone]]
        )
        rows[f"left_{name}"] = dict(zip(members.tolist(), weights.tolist(), strict=True))
        mirrored = mesh.surface.mirror[members]
        rows[f"right_{name}"] = dict(zip(mirrored.tolist(), weights.tolist(), strict=True))
    return with_rows(landmarks, rows)


def nearest(
    vertices: Vertices, point: Float[np.ndarray, "3"], count: int
) -> Integer[np.ndarray, " c"]:
    """The vertices nearest to a point."""
    return np.argsort(np.linalg.norm(vertices - point, axis=1), kind="stable")[:count]


def inner_weights(
    skins: list[Float[np.ndarray, "_ c 3"]], points: list[Float[np.ndarray, "_ 3"]]
) -> Float[np.ndarray, " c"]:
    """Weights w with sum 1 that minimise Σ_sets mean_s |Σ_c w_c x_sc - p_s|² + ridge |w|²."""
    count = skins[0].shape[1]
    system = np.zeros((count + 1, count + 1))
    system[:count, :count] = RIDGE * np.eye(count)
    for skin, point in zip(skins, points, strict=True):
        offsets = (skin - point[:, None]).transpose(0, 2, 1).reshape(-1, count)
        system[:count, :count] += offsets.T @ offsets / len(skin)
    system[:count, count] = system[count, :count] = 1.0
    return np.linalg.solve(system, np.append(np.zeros(count), 1.0))[:count]


SAMPLES = 200
"""Bodies that the centres are fitted on."""

SAMPLE_REACH = 0.5
"""Share of each parameter's range that they explore about the neutral body."""

_SEED = 5

_SHAFTS: Mapping[str, tuple[str, str]] = {
    "upperarm02": ("upperarm01", "lowerarm01"),
    "lowerarm02": ("lowerarm01", "wrist"),
    "upperleg02": ("upperleg01", "lowerleg01"),
    "lowerleg02": ("lowerleg01", "foot"),
}
"""Bones within a limb, whose centre lies on the line between its ends: they only twist about it."""


def with_skin_centres(rig: Rig, base: BaseMesh, space: BodySpace) -> Rig:
    """The rig with bone centres that depend on the body's vertices alone.

    Of one gender: one row for both left women's elbows 9 mm behind their cubes. Only bones that
    turn against their parent have a centre of their own; the others (fingers, toes, face) move with
    their parent about any, and keep their cubes.
    """
    sources = sample_sources(space)
    cubes = np.stack([rig.head_rows @ source for source in sources])
    bodies = base.body(sources)
    names = rig.bone_names
    turning = turning_bones(rig)
    dense = np.zeros((len(names), bodies.shape[1]))
    for bone in turning:
        stem, _, side = names[bone].partition(".")
        if side != "R" and stem not in _SHAFTS:
            dense[bone] = _row(bodies, cubes[:, bone], rig.drives.axis[bone], base.mirror)
    for shaft, ends in _SHAFTS.items():
        bone, first, last = (names.index(f"{stem}.L") for stem in (shaft, *ends))
        share = _share_of_way(*cubes.mean(axis=0)[[first, last, bone]])
        dense[bone] = (1.0 - share) * dense[first] + share * dense[last]
    for bone in turning:
        stem, _, side = names[bone].partition(".")
        if side == "R":
            dense[bone, base.mirror] = dense[names.index(f"{stem}.L")]
        elif not side:
            dense[bone] = 0.5 * (dense[bone] + dense[bone, base.mirror])
    rows = sparse.lil_array(rig.head_rows)
    for bone in turning:
        row = np.zeros(len(base.source_vertices))
        row[base.body_vertex_ids] = dense[bone]
        rows[[bone]] = row[None]
    return replace(rig, head_rows=sparse.csr_array(rows))


def turning_bones(rig: Rig) -> Integer[np.ndarray, " k"]:
    """Bones that a pose can turn against their parent, the root among them."""
    drives = rig.drives
    columns = (drives.part, drives.swing, drives.twist)
    beyond = (drives.beyond, drives.beyond_swing, drives.beyond_twist)
    followed = np.stack([*columns, *beyond], axis=1)
    with_parent = (followed == followed[rig.bone_parent]).all(axis=1)
    return np.flatnonzero(~with_parent | (rig.bone_parent < 0))


def sample_sources(space: BodySpace) -> Float[np.ndarray, "s v 3"]:
    """Source vertices of bodies of all ages, ancestries, statures and weights."""
    rng = np.random.default_rng(_SEED)
    return np.stack(
        [
            source_vertices(
                space,
                _random_traits(rng),
                space.neutral
                + SAMPLE_REACH
                * (space.upper - space.lower)
                * rng.uniform(-1.0, 1.0, len(space.neutral)),
            )
            for _ in range(SAMPLES)
        ]
    )


def _random_traits(rng: np.random.Generator) -> Traits:
    return Traits(
        age=float(rng.uniform(YOUNG_AGE, 1.0)),
        ancestry=rng.dirichlet(np.ones(3)),
        face=np.zeros(len(FACE_CHANGES)),
    )


def _row(
    bodies: Float[np.ndarray, "s m 3"],
    cubes: Float[np.ndarray, "s 3"],
    axis: Float[np.ndarray, "3"],
    mirror: Integer[np.ndarray, " m"],
) -> Float[np.ndarray, " m"]:
    chosen = ring_about(bodies.mean(axis=0) - cubes.mean(axis=0), axis)
    if abs(cubes[:, 0]).max() < 1e-6:
        chosen = np.unique(np.concatenate([chosen, mirror[chosen]]))
    row = np.zeros(bodies.shape[1])
    row[chosen] = convex_weights(bodies[:, chosen], cubes)
    return row


def _share_of_way(
    start: Float[np.ndarray, "3"], end: Float[np.ndarray, "3"], point: Float[np.ndarray, "3"]
) -> float:
    """Share of the way from start to end at which a point lies, 0 to 1."""
    way = end - start
    return float((point - start) @ way / (way @ way))
