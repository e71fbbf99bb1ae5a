"""A person as coloured meshes in the world, for the renderer."""

from functools import cache

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vertices
from tests.accuracy.garments import garment_meshes
from tests.accuracy.looks import HAIR_ROUGHNESS, Canvas, paint
from tests.accuracy.meshes import (
    PersonMesh,
    Refined,
    faces_of_group,
    refined,
    texture_coordinates,
    triangulated,
    vertex_normals,
)
from tests.accuracy.people import rest_landmarks, rig_of_people
from tests.accuracy.scene import Hair, Label
from tests.accuracy.staging import Staged, body_group_ids

REFINEMENTS = 3
"""Thrice: colours lie on vertices, which are then one to four millimetres apart."""

EYE_ROUGHNESS = 0.15

PUPIL_DEGREES = 9.0
IRIS_DEGREES = 25.0
SCLERA_ALBEDO = 0.65
IRIS_ALBEDO = (0.06, 0.045, 0.03)
PUPIL_ALBEDO = 0.004
LASH_ALBEDO = 0.02

BUN_RADIUS_M = 0.035
BUN_BEHIND_EARS_M = 0.115


def person_meshes(staged: Staged, rng: np.random.Generator) -> list[PersonMesh]:
    """Body, eyes and lashes, a knot of hair where it is tied, and what is worn."""
    person = [*_body(staged, rng), *_eyes(staged), *_lashes(staged)]
    return [*person, *garment_meshes(staged, rng)]


def _body(staged: Staged, rng: np.random.Generator) -> list[PersonMesh]:
    ids = body_group_ids()
    local, fine = _refined_body()
    look = staged.case.look
    painted = paint(
        _canvas(staged, fine, local),
        rest_landmarks(staged.person),
        staged.person.gender,
        look,
        rng,
    )
    posed = staged.source_vertices(ids)
    triangles = triangulated(fine.quads)
    flat = fine.rows @ posed
    smooth = fine.rows @ vertex_normals(posed, triangulated(local))
    vertices = flat + painted.relief_m[:, None] * smooth
    # The quads are flat, the body is round: normals come from the coarse mesh, and only the relief
    # adds what the fine mesh shows of it.
    normals = smooth + vertex_normals(vertices, triangles) - vertex_normals(flat, triangles)
    body = PersonMesh(
        vertices=vertices,
        normals=normals,
        triangles=triangles,
        albedo=painted.albedo,
        roughness=painted.roughness,
        labels=painted.labels,
    )
    return [body, _bun(staged)] if look.hair is Hair.TIED else [body]


@cache
def _refined_body() -> tuple[np.ndarray, Refined]:
    """The body's quads, and refined; alike for everybody."""
    ids = body_group_ids()
    local = np.searchsorted(ids, faces_of_group("body").quads)
    return local, refined(local, len(ids), times=REFINEMENTS)


def _canvas(staged: Staged, fine: Refined, quads: np.ndarray) -> Canvas:
    ids = body_group_ids()
    mesh = rig_of_people()
    follows = np.zeros((len(ids), 2))
    names = mesh.rig.bone_names
    trunk = [name.startswith(("root", "pelvis", "spine", "breast", "clavicle")) for name in names]
    legs = [name.startswith("upperleg") for name in names]
    skin = mesh.rig.weights[ids]
    follows[:, 0] = skin @ np.array(trunk, dtype=float)
    follows[:, 1] = skin @ np.array(legs, dtype=float)
    uv = np.zeros((len(ids), 2))
    uv[quads.ravel()] = texture_coordinates()[faces_of_group("body").uv_quads.ravel()]
    fine_follows = fine.rows @ follows
    return Canvas(
        rest=fine.rows @ staged.person.source_vertices[ids],
        uv=fine.rows @ uv,
        trunk=fine_follows[:, 0],
        legs=fine_follows[:, 1],
    )


def _eyes(staged: Staged) -> list[PersonMesh]:
    meshes: list[PersonMesh] = []
    for side in "lr":
        ids, local = _group(f"helper-{side}-eye")
        fine = refined(local, len(ids), times=2)
        rest = fine.rows @ staged.person.source_vertices[ids]
        away = rest - rest.mean(axis=0)
        off_axis = np.degrees(np.arctan2(np.hypot(away[:, 0], away[:, 1]), away[:, 2]))
        albedo = np.full((len(rest), 3), SCLERA_ALBEDO)
        albedo[off_axis < IRIS_DEGREES] = IRIS_ALBEDO
        albedo[off_axis < PUPIL_DEGREES] = PUPIL_ALBEDO
        posed = fine.rows @ staged.source_vertices(ids)
        meshes.append(_plain(posed, triangulated(fine.quads), albedo, EYE_ROUGHNESS, Label.SKIN))
    return meshes


def _lashes(staged: Staged) -> list[PersonMesh]:
    meshes: list[PersonMesh] = []
    for group in (f"helper-{side}-eyelashes-{row}" for side in "lr" for row in (1, 2)):
        ids, local = _group(group)
        albedo = np.full((len(ids), 3), LASH_ALBEDO)
        posed = staged.source_vertices(ids)
        meshes.append(_plain(posed, triangulated(local), albedo, HAIR_ROUGHNESS, Label.SKIN))
    return meshes


def _bun(staged: Staged) -> PersonMesh:
    """A knot of hair behind the crown."""
    points = rest_landmarks(staged.person)
    ear = 0.5 * (points["left_ear"] + points["right_ear"])
    centre = np.array([0.0, 0.4 * ear[1] + 0.6 * points["crown"][1], ear[2] - BUN_BEHIND_EARS_M])
    latitude, longitude = np.meshgrid(
        np.linspace(-0.5 * np.pi, 0.5 * np.pi, 40), np.linspace(0.0, 2.0 * np.pi, 80)
    )
    directions = np.stack(
        [
            np.cos(latitude) * np.cos(longitude),
            np.cos(latitude) * np.sin(longitude),
            np.sin(latitude),
        ],
        axis=-1,
    )
    rolls = 1.0 + 0.04 * np.sin(9.0 * latitude + 2.0 * longitude)
    rest = (centre + BUN_RADIUS_M * rolls[..., None] * directions).reshape(-1, 3)
    number = np.arange(rest.shape[0]).reshape(latitude.shape)
    quads = np.stack(
        [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1
    ).reshape(-1, 4)
    colour = np.array(staged.case.look.hair_colour)
    albedo = colour * np.exp(4.0 * (rolls.reshape(-1, 1) - 1.0))
    posed = staged.on_bone("head", rest)
    return _plain(posed, triangulated(quads), albedo, HAIR_ROUGHNESS, Label.HAIR)


def _group(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Source vertices of a group and its quads over them."""
    quads = faces_of_group(name).quads
    ids = np.unique(quads)
    return ids, np.searchsorted(ids, quads)


def _plain(
    vertices: Vertices,
    triangles: np.ndarray,
    albedo: Float[np.ndarray, "k 3"],
    roughness: float,
    label: Label,
) -> PersonMesh:
    return PersonMesh(
        vertices=vertices,
        normals=vertex_normals(vertices, triangles),
        triangles=triangles,
        albedo=albedo,
        roughness=np.full(len(vertices), roughness),
        labels=np.full(len(vertices), label),
    )
