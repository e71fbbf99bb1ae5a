"""Held-out people: solved for once, kept as files, posed by MakeHuman's own rig.

The training draws its subjects from streams of its own seed; the people here come from other
seeds. Files keep them as they are when the training's population changes, so that the pictures
stay true: all source vertices as differences from the base mesh, in steps of 0.05 mm.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy import sparse

from fitter.arrays import Pose, Vertices
from fitter.body.model import BodyModel, regress
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.training.articulation.joints import joint_rows_of_bones
from fitter.training.articulation.rig import bone_heads, load_rig, posed_vertices
from fitter.training.articulation.rigged_bodies import RiggedMesh, rigged_mesh, with_curled_fingers
from fitter.training.makehuman.meshes import BaseMesh, load_base_mesh, makehuman_folder
from fitter.vocabulary.choices import Gender
from tests.accuracy.scene import PersonSource

PEOPLE_FOLDER = Path(__file__).parent / "data" / "people"

STEP_M = 5e-5
"""A file's unit: its rounding moves a normal by less than a hundredth of a radian."""

INNER_POINT_BONES: Mapping[str, str] = {
    "shoulder": "upperarm01",
    "elbow": "lowerarm01",
    "wrist": "wrist",
    "hip": "upperleg01",
    "knee": "lowerleg01",
    "ankle": "foot",
}
"""Points people click inside the body: the bone whose head lies there."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Person:
    """A body at rest.

    ``source_vertices`` (v, 3) body frame, metres; ``joints`` (p, 3) the true centres of the parts.
    """

    gender: Gender
    source_vertices: Vertices
    joints: Float[np.ndarray, "p 3"]


@cache
def rig_of_people() -> RiggedMesh:
    """The rigged base mesh; read once."""
    folder = makehuman_folder()
    base = load_base_mesh(folder)
    return rigged_mesh(base, load_rig(folder, base.groups, len(base.source_vertices)))


def person_at_rest(gender: Gender, source_vertices: Vertices) -> Person:
    """A person from their source vertices."""
    rig = rig_of_people().rig
    rows = joint_rows_of_bones(rig.bone_names)
    return Person(
        gender=gender,
        source_vertices=source_vertices,
        joints=rows @ bone_heads(rig, source_vertices),
    )


def save_person(path: Path, source_vertices: Vertices) -> None:
    """Write a person's file, as was done once for each."""
    steps = np.rint((source_vertices - _base().source_vertices) / STEP_M)
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(path, displacement_steps=steps.astype(np.int16))


def load_person(source: PersonSource, folder: Path = PEOPLE_FOLDER) -> Person:
    """Read what :func:`save_person` wrote."""
    with np.load(folder / f"{source.name}.npz", allow_pickle=False) as archive:
        steps = archive["displacement_steps"]
    return person_at_rest(source.gender, _base().source_vertices + STEP_M * steps)


def posed_body(person: Person, pose: Pose) -> Vertices:
    """The body's vertices in a pose, in the body model's order, hands as at rest."""
    mesh = rig_of_people()
    heads = bone_heads(mesh.rig, person.source_vertices)
    rest = mesh.surface.body(person.source_vertices)
    return posed_vertices(mesh.rig, mesh.skin, rest, heads, pose)


def posed_bones(person: Person, pose: Pose) -> Mapping[str, Float[np.ndarray, "3"]]:
    """Where the heads of all bones are in a pose, by name."""
    rig = rig_of_people().rig
    heads = bone_heads(rig, person.source_vertices)
    own = sparse.csr_array(np.eye(len(heads)))
    return dict(zip(rig.bone_names, posed_vertices(rig, own, heads, heads, pose), strict=True))


def posed_with_bone(person: Person, pose: Pose, *, bone: str, points: Vertices) -> Vertices:
    """Points fixed to one bone, in a pose."""
    rig = rig_of_people().rig
    heads = bone_heads(rig, person.source_vertices)
    follows = np.zeros((len(points), len(heads)))
    follows[:, rig.bone_names.index(bone)] = 1.0
    return posed_vertices(rig, sparse.csr_array(follows), points, heads, pose)


def posed_skin(
    person: Person, pose: Pose, *, curl: Mapping[str, float], vertex_ids: np.ndarray
) -> Vertices:
    """Chosen source vertices in a pose with curled fingers.

    ``curl`` gives the degrees each finger joint bends, by side.
    """
    rig = rig_of_people().rig
    heads = bone_heads(rig, person.source_vertices)
    skin = sparse.csr_array(rig.weights[vertex_ids])
    rest = person.source_vertices[vertex_ids]
    return posed_vertices(rig, skin, with_curled_fingers(rig, skin, rest, heads, curl), heads, pose)


def _base() -> BaseMesh:
    return rig_of_people().surface


Points = Mapping[str, Float[np.ndarray, "3"]]


@cache
def packaged_model(gender: Gender) -> BodyModel:
    """The model shipped with the package, for its definitions alone."""
    return load_body_model(packaged_model_path(gender.value))


def landmarks_on(gender: Gender, body: Vertices) -> Points:
    """The body model's own landmarks by name, on a true mesh, in its frame."""
    rows = packaged_model(gender).landmarks
    return dict(zip(rows.names, regress(rows, body), strict=True))


def rest_landmarks(person: Person) -> Points:
    """Landmarks of a person at rest, body frame, metres."""
    return landmarks_on(person.gender, rig_of_people().surface.body(person.source_vertices))
