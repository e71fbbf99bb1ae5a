"""Random people who stand, and the places of their skin by which garments are cut."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np
from jaxtyping import Bool, Float, Integer
from scipy import sparse

from fitter.arrays import Normals, Triangles, Vector3, Vertices
from fitter.body.model import BodyModel, regress
from fitter.body.scape import ScapeEvaluator
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.numerics.meshes import summed_cross_products
from fitter.numerics.rotations import rotation_matrices
from fitter.parameters import BodyParameters
from fitter.training.articulation.poses import relative_pose, rotation_between
from fitter.vocabulary.choices import Gender

SIDES: Final = (("left", 1.0), ("right", -1.0))

ARMS_OUT: Final = {"raised": (25.0, 60.0), "hanging": (6.0, 18.0), "level": (65.0, 92.0)}
"""Degrees from straight down, outward; ``anyhow`` is anything, with bent elbows."""

STANCES: Final = {"raised": 0.45, "hanging": 0.3, "level": 0.07, "anyhow": 0.18}

STRIDING: Final = 0.25

SHOULDER_SHARE: Final = 0.25
"""Places off the arms lie no farther along them."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RestBody:
    """A model's mean body at rest.

    Attributes
    ----------
    part_of_vertex
        (m,) one of the parts it belongs to.
    along_arm
        (m,) 0 at the shoulder, 1 at the wrist.
    neighbours
        (m, m) takes the mean over a vertex' neighbours.
    """

    gender: Gender
    model: BodyModel
    evaluator: ScapeEvaluator
    part_of_vertex: Integer[np.ndarray, " m"]
    along_arm: Float[np.ndarray, " m"]
    marks: Mapping[str, Vector3]
    neighbours: sparse.csr_array

    @property
    def points(self) -> Vertices:
        """(m, 3) body frame."""
        return self.model.mean_vertices

    @property
    def floor(self) -> float:
        """Height of the soles."""
        return float(self.points[:, 1].min())

    def on(self, *kinds: str) -> Bool[np.ndarray, " m"]:
        """Vertices of parts of some kinds: ``forearm``, ``foot`` and so on, of either side."""
        own = [
            number
            for number, name in enumerate(self.model.part_names)
            if name.removeprefix("left_").removeprefix("right_") in kinds
        ]
        return np.isin(self.part_of_vertex, own)

    @property
    def on_arms(self) -> Bool[np.ndarray, " m"]:
        """Arms and hands."""
        return self.on("upper_arm", "forearm", "hand")

    @property
    def on_legs(self) -> Bool[np.ndarray, " m"]:
        """Thighs to feet."""
        return self.on("thigh", "shin", "foot")

    @property
    def on_head(self) -> Bool[np.ndarray, " m"]:
        """Head and neck."""
        return self.on("neck", "head")

    def places(self) -> Float[np.ndarray, "m 5"]:
        """x, y, z at rest, along the arm, and 1 on arms: by these garments are cut and painted."""
        return np.column_stack([self.points, self.along_arm, self.on_arms])

    def triangles_of(self, chosen: Bool[np.ndarray, " m"]) -> Triangles:
        """Triangles with all corners chosen."""
        triangles = self.model.triangles
        return triangles[chosen[triangles].all(axis=1)]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StandingBody:
    """A posed body, body frame, root at the origin.

    ``normals`` (m, 3) are area-weighted, of any length.
    """

    rest: RestBody
    vertices: Vertices
    normals: Normals
    marks: Mapping[str, Vector3]

    @property
    def stature_m(self) -> float:
        """Height as it stands."""
        return float(np.ptp(self.vertices[:, 1]))

    @property
    def scale(self) -> float:
        """Height over that at rest."""
        return self.stature_m / float(np.ptp(self.rest.points[:, 1]))


@cache
def rest_body(gender: Gender) -> RestBody:
    """The packaged model's mean body."""
    model = load_body_model(packaged_model_path(gender))
    marks = _marks(model, model.mean_vertices)
    parts = np.zeros(len(model.mean_vertices), dtype=int)
    parts[model.triangles.ravel()] = np.repeat(model.part_of_triangle, 3)
    on_arm = np.array(["arm" in name or "hand" in name for name in model.part_names])[parts]
    along = _along_arms(model.mean_vertices, marks)
    return RestBody(
        gender=gender,
        model=model,
        evaluator=ScapeEvaluator(model),
        part_of_vertex=parts,
        along_arm=np.where(on_arm, along, np.minimum(along, SHOULDER_SHARE)),
        marks=marks,
        neighbours=_neighbours(model.triangles, len(parts)),
    )


def standing_body(rng: np.random.Generator) -> StandingBody:
    """A person of random gender and shape who stands somehow."""
    rest = rest_body(Gender.FEMALE if rng.random() < 0.5 else Gender.MALE)
    turned = _trunk_turns(rest, rng)
    kind = str(rng.choice(list(STANCES), p=list(STANCES.values())))
    arms_out = rng.uniform(*ARMS_OUT[kind]) if kind in ARMS_OUT else None
    stride = rng.uniform(-25.0, 25.0) if rng.random() < STRIDING else 0.0
    legs_out = rng.uniform(0.0, 16.0)
    for side, sign in SIDES:
        turned |= _arm_turns(rest, side, sign, arms_out, rng)
        turned |= _leg_turns(rest, side, sign, stride * sign, legs_out, rng)
    names = rest.model.part_names
    pose = relative_pose(np.stack([turned.get(name, np.eye(3)) for name in names]))
    shape = rng.normal(size=len(rest.model.shape_basis))
    vertices = rest.evaluator.body_frame_vertices(
        BodyParameters(pose=pose, translation=np.zeros(3), shape=shape)
    )
    return StandingBody(
        rest=rest,
        vertices=vertices,
        normals=summed_cross_products(vertices, rest.model.triangles),
        marks=_marks(rest.model, vertices),
    )


Turns = dict[str, Float[np.ndarray, "3 3"]]


def _trunk_turns(rest: RestBody, rng: np.random.Generator) -> Turns:
    turned: Turns = {}
    before = np.eye(3)
    for part, bend, lean, twist in (
        ("spine", 4.0, 3.0, 5.0),
        ("chest", 3.0, 0.0, 5.0),
        ("neck", 6.0, 0.0, 10.0),
        ("head", 8.0, 5.0, 12.0),
    ):
        before = before @ turn("x", rng.normal(0.0, bend)) @ turn("y", rng.normal(0.0, twist))
        before = before @ turn("z", rng.normal(0.0, lean))
        turned[part] = before
    return turned


def _arm_turns(
    rest: RestBody, side: str, sign: float, out: float | None, rng: np.random.Generator
) -> Turns:
    shoulder, elbow, wrist = (
        rest.marks[f"{side}_{mark}"] for mark in ("shoulder", "elbow", "wrist")
    )
    anyhow = out is None
    outward = rng.uniform(5.0, 100.0) if anyhow else out + rng.normal(0.0, 5.0)
    forward = rng.uniform(-30.0, 50.0) if anyhow else rng.normal(0.0, 8.0)
    upper = turn("x", -forward) @ _down_and_out(outward, sign)
    bend = rng.uniform(0.0, 120.0) if anyhow else abs(rng.normal(8.0, 8.0))
    hinge = np.cross(upper, [-sign * rng.uniform(0.0, 1.2), 0.1, 1.0])
    hinge *= np.radians(bend) / np.linalg.norm(hinge)
    lower = rotation_matrices(hinge[None])[0] @ upper
    forearm = rotation_between(wrist - elbow, lower)
    return {
        f"{side}_upper_arm": rotation_between(elbow - shoulder, upper),
        f"{side}_forearm": forearm,
        f"{side}_hand": forearm @ turn("x", rng.normal(0, 10.0)) @ turn("z", rng.normal(0, 12.0)),
    }


def _leg_turns(
    rest: RestBody, side: str, sign: float, stride: float, out: float, rng: np.random.Generator
) -> Turns:
    hip, knee, ankle = (rest.marks[f"{side}_{mark}"] for mark in ("hip", "knee", "ankle"))
    forward = stride + rng.normal(0.0, 3.0)
    thigh = turn("x", -forward) @ _down_and_out(out + rng.normal(0.0, 3.0), sign)
    bend = abs(rng.normal(0.0, 6.0)) + max(0.0, -stride)
    return {
        f"{side}_thigh": rotation_between(knee - hip, thigh),
        f"{side}_shin": rotation_between(ankle - knee, turn("x", bend) @ thigh),
        f"{side}_foot": turn("y", sign * rng.uniform(0.0, 25.0)),
    }


def turn(axis: str, degrees: float) -> Float[np.ndarray, "3 3"]:
    """Rotation about a body axis."""
    return rotation_matrices((np.radians(degrees) * np.eye(3)["xyz".index(axis)])[None])[0]


def _down_and_out(degrees: float, sign: float) -> Vector3:
    return np.array([sign * np.sin(np.radians(degrees)), -np.cos(np.radians(degrees)), 0.0])


def _marks(model: BodyModel, vertices: Vertices) -> dict[str, Vector3]:
    return dict(zip(model.landmarks.names, regress(model.landmarks, vertices), strict=True))


def _along_arms(points: Vertices, marks: Mapping[str, Vector3]) -> Float[np.ndarray, " m"]:
    along = np.zeros(len(points))
    for side, sign in SIDES:
        shoulder, elbow, wrist = (
            marks[f"{side}_{mark}"] for mark in ("shoulder", "elbow", "wrist")
        )
        upper, lower = elbow - shoulder, wrist - elbow
        lengths = np.linalg.norm(upper), np.linalg.norm(lower)
        first = (points - shoulder) @ upper / lengths[0]
        second = np.maximum((points - elbow) @ lower / lengths[1], 0.0)
        whole = np.where(first < lengths[0], first, lengths[0] + second)
        own = sign * points[:, 0] > 0.0
        along[own] = whole[own] / sum(lengths)
    return along


def _neighbours(triangles: Triangles, count: int) -> sparse.csr_array:
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    rows, columns = np.concatenate([ends, ends[:, ::-1]]).T
    joined = sparse.csr_array((np.ones(len(rows)), (rows, columns)), shape=(count, count))
    joined.data[:] = 1.0
    return sparse.csr_array(sparse.diags_array(1.0 / joined.sum(axis=1)) @ joined)
