"""The picture in linear light, path-traced by Mitsuba 3: a renderer that shares no code with ours.

A lamp of a few centimetres, light from all round, shadows on floor and wall, light that the walls
throw back, a skin with a broad gloss.
"""

from dataclasses import dataclass
from typing import Any

import mitsuba
import numpy as np
from jaxtyping import Bool, Float

from fitter.arrays import Normals, Triangles, Vertices
from tests.evaluation.landmark_points import rest_landmarks
from tests.evaluation.looks import HAIR_ROUGHNESS, Canvas, paint
from tests.evaluation.makehuman_faces import faces_of_group, texture_coordinates
from tests.evaluation.people import rig_of_people
from tests.evaluation.refinement import Refined, refined, triangulated, vertex_normals
from tests.evaluation.scene import Hair
from tests.evaluation.staging import Staged, body_group_ids, lamp_place
from tests.evaluation.surroundings import (
    FLOOR_SIZE_M,
    WALL_SIZE_M,
    floor_texture,
    wall_texture,
)

REFINEMENTS = 3
LONGEST_PATH = 5

SPECULAR = 0.35
EYE_ROUGHNESS = 0.15

PUPIL_DEGREES = 9.0
IRIS_DEGREES = 25.0
SCLERA_ALBEDO = 0.65
IRIS_ALBEDO = (0.06, 0.045, 0.03)
PUPIL_ALBEDO = 0.004
LASH_ALBEDO = 0.02

BUN_RADIUS_M = 0.035
BUN_BEHIND_EARS_M = 0.115

_MIRRORED_AXES = np.array([-1.0, -1.0, 1.0])
"""Mitsuba's camera has x to the left and y up."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Mesh:
    vertices: Vertices
    normals: Normals
    triangles: Triangles
    albedo: Float[np.ndarray, "k 3"]
    roughness: Float[np.ndarray, " k"]


def linear_picture(staged: Staged, *, samples: int, seed: int) -> Float[np.ndarray, "h w 3"]:
    """Path-trace a case."""
    _choose_variant()
    rng = np.random.default_rng(seed)
    scene: Any = mitsuba.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": LONGEST_PATH},
            "sensor": _sensor(staged, samples),
            **_lights(staged),
            **_room(staged, rng),
            **{f"mesh{k}": _shape(mesh) for k, mesh in enumerate(_person(staged, rng))},
        }
    )
    return np.array(mitsuba.render(scene, spp=samples, seed=seed), dtype=np.float64)[..., :3]


def person_mask(staged: Staged, *, seed: int) -> Bool[np.ndarray, "h w"]:
    """Pixels whose centre shows the person, hair and clothes included."""
    _choose_variant()
    rng = np.random.default_rng(seed)
    sensor = _sensor(staged, 1)
    sensor["film"]["rfilter"] = {"type": "box"}
    sensor["sampler"] = {"type": "stratified", "sample_count": 1, "jitter": False}
    scene: Any = mitsuba.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "depth"},
            "sensor": sensor,
            **{f"mesh{k}": _shape(mesh) for k, mesh in enumerate(_person(staged, rng))},
        }
    )
    return np.array(mitsuba.render(scene, spp=1), dtype=np.float64)[..., 0] > 0.0


def _choose_variant() -> None:
    if mitsuba.variant() is None:
        mitsuba.set_variant("scalar_rgb")


def _sensor(staged: Staged, samples: int) -> dict[str, Any]:
    camera = staged.camera
    transform = np.eye(4)
    transform[:3, :3] = staged.to_camera.T * _MIRRORED_AXES
    transform[:3, 3] = staged.eye
    half_width = camera.width / (2.0 * camera.focal_length_px)
    return {
        "type": "perspective",
        "fov_axis": "x",
        "fov": float(np.degrees(2.0 * np.arctan(half_width))),
        "near_clip": 0.05,
        "to_world": mitsuba.ScalarTransform4f(transform.tolist()),
        "film": {
            "type": "hdrfilm",
            "width": camera.width,
            "height": camera.height,
            "rfilter": {"type": "gaussian"},
            "pixel_format": "rgb",
        },
        "sampler": {"type": "multijitter", "sample_count": samples},
    }


def _lights(staged: Staged) -> dict[str, Any]:
    lighting = staged.case.lighting
    # A white surface that faces a sphere of radiance L and radius r at distance d gets L r²/d².
    radiance = lighting.strength * (lighting.distance_m / lighting.lamp_radius_m) ** 2
    return {
        "ambient": {"type": "constant", "radiance": {"type": "rgb", "value": lighting.ambient}},
        "lamp": {
            "type": "sphere",
            "center": lamp_place(staged).tolist(),
            "radius": lighting.lamp_radius_m,
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": radiance}},
        },
    }


def _room(staged: Staged, rng: np.random.Generator) -> dict[str, Any]:
    surroundings = staged.case.surroundings
    transform = mitsuba.ScalarTransform4f
    behind = -surroundings.wall_distance_m
    wall = (
        transform()
        .translate([0.0, WALL_SIZE_M[1] / 2.0, behind])
        .scale([WALL_SIZE_M[0] / 2.0, WALL_SIZE_M[1] / 2.0, 1.0])
    )
    floor = (
        transform()
        .translate([0.0, 0.0, behind + FLOOR_SIZE_M[1] / 2.0])
        .rotate([1.0, 0.0, 0.0], -90.0)
        .scale([FLOOR_SIZE_M[0] / 2.0, FLOOR_SIZE_M[1] / 2.0, 1.0])
    )
    return {
        "wall": _sheet(wall, wall_texture(surroundings, rng)),
        "floor": _sheet(floor, floor_texture(surroundings, rng)),
    }


def _sheet(to_world: Any, texture: Float[np.ndarray, "h w 3"]) -> dict[str, Any]:
    return {
        "type": "rectangle",
        "to_world": to_world,
        "bsdf": {
            "type": "diffuse",
            "reflectance": {
                "type": "bitmap",
                "bitmap": mitsuba.Bitmap(texture.astype(np.float32)),
                "raw": True,
                "wrap_mode": "mirror",
            },
        },
    }


def _person(staged: Staged, rng: np.random.Generator) -> list[_Mesh]:
    return [*_body(staged, rng), *_eyes(staged), *_lashes(staged)]


def _body(staged: Staged, rng: np.random.Generator) -> list[_Mesh]:
    faces, ids = faces_of_group("body"), body_group_ids()
    local = np.searchsorted(ids, faces.quads)
    fine = refined(local, len(ids), times=REFINEMENTS)
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
    body = _Mesh(
        vertices=vertices,
        normals=normals,
        triangles=triangles,
        albedo=painted.albedo,
        roughness=painted.roughness,
    )
    return [body, _bun(staged)] if look.hair is Hair.TIED else [body]


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


def _eyes(staged: Staged) -> list[_Mesh]:
    meshes: list[_Mesh] = []
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
        meshes.append(_plain(posed, triangulated(fine.quads), albedo, EYE_ROUGHNESS))
    return meshes


def _lashes(staged: Staged) -> list[_Mesh]:
    meshes: list[_Mesh] = []
    for group in (f"helper-{side}-eyelashes-{row}" for side in "lr" for row in (1, 2)):
        ids, local = _group(group)
        albedo = np.full((len(ids), 3), LASH_ALBEDO)
        posed = staged.source_vertices(ids)
        meshes.append(_plain(posed, triangulated(local), albedo, HAIR_ROUGHNESS))
    return meshes


def _bun(staged: Staged) -> _Mesh:
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
    return _plain(staged.on_bone("head", rest), triangulated(quads), albedo, HAIR_ROUGHNESS)


def _group(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Source vertices of a group and its quads over them."""
    quads = faces_of_group(name).quads
    ids = np.unique(quads)
    return ids, np.searchsorted(ids, quads)


def _plain(
    vertices: Vertices, triangles: np.ndarray, albedo: Float[np.ndarray, "k 3"], roughness: float
) -> _Mesh:
    return _Mesh(
        vertices=vertices,
        normals=vertex_normals(vertices, triangles),
        triangles=triangles,
        albedo=albedo,
        roughness=np.full(len(vertices), roughness),
    )


def _shape(mesh: _Mesh) -> Any:
    used = np.unique(mesh.triangles)
    triangles = np.searchsorted(used, mesh.triangles)
    vertices, normals = mesh.vertices[used], mesh.normals[used]
    properties = mitsuba.Properties()
    properties["bsdf"] = mitsuba.load_dict(
        {
            "type": "twosided",
            "bsdf": {
                "type": "principled",
                "base_color": {"type": "mesh_attribute", "name": "vertex_color"},
                "roughness": {"type": "mesh_attribute", "name": "vertex_roughness"},
                "specular": SPECULAR,
            },
        }
    )
    shape = mitsuba.Mesh(
        "person",
        vertex_count=len(vertices),
        face_count=len(triangles),
        has_vertex_normals=True,
        props=properties,
    )
    shape.add_attribute("vertex_color", 3, mesh.albedo[used].astype(np.float32).ravel())
    shape.add_attribute("vertex_roughness", 1, mesh.roughness[used].astype(np.float32))
    contents = mitsuba.traverse(shape)
    contents["vertex_positions"] = vertices.astype(np.float32).ravel()
    contents["vertex_normals"] = normals.astype(np.float32).ravel()
    contents["faces"] = triangles.astype(np.uint32).ravel()
    contents.update()
    return shape
