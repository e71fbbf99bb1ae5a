"""Landmarks on the body as weighted sums of its vertices.

Every landmark is found by what it is, on the average of both genders' average bodies: an extremum
near a joint, the vertex a target moves most, the rim of an eye. The points of the COCO convention
that lie inside the body (shoulder, elbow, wrist, hip, knee, ankle) are fitted to the subjects that
a model is trained on (:mod:`fitter.training.articulation.bone_centres`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vector3, Vertices
from fitter.body.model import SparseRows
from fitter.training.makehuman.body_space import BodySpace, average_traits, source_vertices
from fitter.training.makehuman.meshes import BaseMesh, load_targets

INNER_NAMES = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")

MIDDLE = 1e-4
"""Metres: a vertex nearer than this to the plane of symmetry lies on it."""

LATERAL_NAMES = (
    "eye",
    "ear",
    *INNER_NAMES,
    "toe",
    "heel",
    "sole",
    "nipple",
    "acromion",
    "finger_tip",
    "mouth_corner",
)

MIDDLE_NAMES = ("nose", "neck", "head_top", "chin", "crown", "navel", "crotch", "cervicale", "seat")

Row = Mapping[int, float]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Scene:
    """The average body with what the search needs; positions in the body frame, metres."""

    base: BaseMesh
    source: Float[np.ndarray, "v 3"]
    body: Vertices

    def joint(self, group: str) -> Vector3:
        return self.source[self.base.groups[group]].mean(axis=0)

    def row(self, vertex: int) -> Row:
        return {int(vertex): 1.0}


def body_landmarks(folder: Path, base: BaseMesh, spaces: Sequence[BodySpace]) -> SparseRows:
    """The landmarks on the skin, as rows over the m body vertices, common to all ``spaces``.

    ``folder`` is MakeHuman's, for the targets that name nipple, navel and ear.
    """
    average = np.mean(
        [source_vertices(space, average_traits(), space.neutral) for space in spaces], axis=0
    )
    scene = _Scene(base=base, source=average, body=base.body(average))
    named = _most_moved(folder, base)
    left: dict[str, Row] = {
        **_left_openings(base),
        "ear": named["ear"],
        "nipple": named["nipple"],
        **_left_extremes(scene),
    }
    rows: dict[str, Row] = {"navel": named["navel"], **_middle_extremes(scene)}
    for name, row in left.items():
        prefixed = _side_names(name)
        rows[prefixed[0]] = row
        rows[prefixed[1]] = {int(base.mirror[vertex]): weight for vertex, weight in row.items()}
    return _sparse(rows)


def _side_names(name: str) -> tuple[str, str]:
    """``sole_left`` but ``left_toe``: the order the model file's readers use."""
    return ("sole_left", "sole_right") if name == "sole" else (f"left_{name}", f"right_{name}")


def _ordered_names() -> tuple[str, ...]:
    coco = ("eye", "ear", *INNER_NAMES)
    rest = tuple(name for name in LATERAL_NAMES if name not in coco)
    return (
        "nose",
        *(side for name in coco for side in _side_names(name)),
        *(name for name in MIDDLE_NAMES if name != "nose"),
        *(side for name in rest for side in _side_names(name)),
    )


def _sparse(rows: Mapping[str, Row]) -> SparseRows:
    """The rows in the order in which model files have them."""
    names = [name for name in _ordered_names() if name in rows]
    chosen = [rows[name] for name in names]
    return SparseRows(
        names=tuple(names),
        pointers=np.cumsum([0, *(len(row) for row in chosen)]).astype(np.int32),
        indices=np.array([vertex for row in chosen for vertex in row], dtype=np.int32),
        weights=np.array([weight for row in chosen for weight in row.values()]),
    )


def with_rows(landmarks: SparseRows, rows: Mapping[str, Row]) -> SparseRows:
    """The landmarks with more of them, in the order in which model files have them."""
    spans = zip(landmarks.pointers[:-1], landmarks.pointers[1:], strict=True)
    kept: dict[str, Row] = {
        name: dict(
            zip(
                landmarks.indices[start:stop].tolist(),
                landmarks.weights[start:stop].tolist(),
                strict=True,
            )
        )
        for name, (start, stop) in zip(landmarks.names, spans, strict=True)
    }
    return _sparse({**kept, **rows})


def _most_moved(folder: Path, base: BaseMesh) -> dict[str, Row]:
    """Points named by the target that shapes them."""
    count = len(base.source_vertices)
    names = ("breast/nipple-size-incr", "stomach/stomach-navel-out", "ears/l-ear-scale-incr")
    nipple, navel, ear = np.linalg.norm(base.body(load_targets(folder, names, count)), axis=2)
    left_side = base.body(base.source_vertices)[:, 0] > MIDDLE
    # The ear's opening lies amid what the ear's scale moves, weighted by how little it moves.
    members = np.flatnonzero(ear > 0.25 * ear.max())
    return {
        "nipple": {int(np.argmax(np.where(left_side, nipple, 0.0))): 1.0},
        "navel": {int(np.argmax(navel)): 1.0},
        "ear": dict.fromkeys(members.tolist(), 1.0 / len(members)),
    }


def _left_openings(base: BaseMesh) -> dict[str, Row]:
    """Eye and corner of the mouth, by the rims where sockets and mouth were cut away.

    The eye is the mean of its lids' rim; the mouth's corner is where its rim reaches farthest out.
    """
    rim = np.unique(base.triangles[base.cap_triangles])
    rest = base.body(base.source_vertices)[rim]
    # The eyes are the two openings above the rims' mean height, the mouth is the one below.
    above = rest[:, 1] > rest[:, 1].mean()
    eye = rim[(rest[:, 0] > MIDDLE) & above]
    mouth = np.flatnonzero(~above)
    corner = int(rim[mouth[np.argmax(rest[mouth, 0])]])
    return {"eye": dict.fromkeys(eye.tolist(), 1.0 / len(eye)), "mouth_corner": {corner: 1.0}}


def _middle_extremes(scene: _Scene) -> dict[str, Row]:
    body = scene.body
    x, y, z = body.T
    middle = np.flatnonzero(np.abs(x) < MIDDLE)
    jaw, neck, clavicle = (
        scene.joint(group) for group in ("joint-jaw", "joint-neck", "joint-l-clavicle")
    )
    mouth, hip, spine = (
        scene.joint(group) for group in ("joint-mouth", "joint-l-upper-leg", "joint-spine-3")
    )
    face = middle[(y[middle] > mouth[1]) & (z[middle] > jaw[2])]
    below_mouth = middle[(y[middle] > neck[1]) & (y[middle] < mouth[1]) & (z[middle] > jaw[2])]
    front = middle[(z[middle] > clavicle[2]) & (y[middle] < jaw[1])]
    back = middle[z[middle] < neck[2]]
    between_legs = middle[y[middle] < hip[1]]
    level = np.flatnonzero((y > y[between_legs].min()) & (y < spine[1]) & (np.abs(x) < hip[0]))
    crown = scene.row(int(middle[np.argmax(y[middle])]))
    seat = int(level[np.argmin(z[level])])
    return {
        "nose": scene.row(int(face[np.argmax(z[face])])),
        "chin": scene.row(int(below_mouth[np.argmax((z - y)[below_mouth])])),
        "neck": scene.row(int(front[np.argmin(np.abs(y[front] - clavicle[1]))])),
        "cervicale": scene.row(int(back[np.argmin(np.abs(y[back] - neck[1]))])),
        "crown": crown,
        "head_top": crown,
        "crotch": scene.row(int(between_legs[np.argmin(y[between_legs])])),
        "seat": {seat: 0.5, int(scene.base.mirror[seat]): 0.5},
    }


def _left_extremes(scene: _Scene) -> dict[str, Row]:
    body = scene.body
    x, y, z = body.T
    ankle, shoulder = scene.joint("joint-l-ankle"), scene.joint("joint-l-shoulder")
    hand, finger = scene.joint("joint-l-hand"), scene.joint("joint-l-finger-3-4")
    toe_joint = scene.joint("joint-l-toe-1-3")
    foot = np.flatnonzero((x > MIDDLE) & (y < ankle[1]))
    rear = foot[z[foot] < ankle[2]]
    ball = foot[z[foot] > 0.5 * (ankle[2] + toe_joint[2])]
    heel_bottom, ball_bottom = (int(part[np.argmin(y[part])]) for part in (rear, ball))
    along = (finger - hand) / np.linalg.norm(finger - hand)
    near_tip = np.flatnonzero(np.linalg.norm(body - finger, axis=1) < 0.03)
    beside = np.hypot(x - shoulder[0], z - shoulder[2])
    above = np.flatnonzero((y > shoulder[1]) & (beside < 0.05) & (y < shoulder[1] + 0.12))
    return {
        "toe": scene.row(int(foot[np.argmax(z[foot])])),
        "heel": scene.row(int(rear[np.argmin(z[rear])])),
        "sole": {heel_bottom: 0.5, ball_bottom: 0.5},
        "finger_tip": scene.row(int(near_tip[np.argmax(body[near_tip] @ along)])),
        "acromion": scene.row(int(above[np.argmin(beside[above])])),
    }
