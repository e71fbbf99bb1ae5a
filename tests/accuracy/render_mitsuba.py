"""The picture in linear light, path-traced by Mitsuba 3: a renderer that shares no code with ours.

A lamp of a few centimetres, light from all round, shadows on floor and wall, light that the walls
throw back, a skin with a broad gloss.
"""

import os
from collections.abc import Mapping, Sequence
from typing import Any

import mitsuba
import numpy as np
from jaxtyping import Float, UInt8

from tests.accuracy.person_meshes import PersonMesh, person_meshes
from tests.accuracy.staging import Staged, lamp_place
from tests.accuracy.surroundings import (
    FLOOR_SIZE_M,
    WALL_SIZE_M,
    floor_texture,
    wall_texture,
)

LLVM_LIBRARY = "DRJIT_LIBLLVM_PATH"

LONGEST_PATH = 5

SPECULAR = 0.35


_MIRRORED_AXES = np.array([-1.0, -1.0, 1.0])
"""Mitsuba's camera has x to the left and y up."""


def linear_picture_and_labels(
    staged: Staged, *, samples: int
) -> tuple[Float[np.ndarray, "h w 3"], UInt8[np.ndarray, "h w"]]:
    """Path-trace a case; and the :class:`Label` of what each pixel's centre shows.

    Both from one set of meshes, which take longer to paint than a small picture to trace.
    """
    _choose_variant()
    case = staged.case
    rng = np.random.default_rng(case.seed if case.surface_seed is None else case.surface_seed)
    meshes = person_meshes(staged, rng)
    person = {f"mesh{k}": _shape(mesh) for k, mesh in enumerate(meshes)}
    linear: Any = mitsuba.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": LONGEST_PATH},
            "sensor": _sensor(staged, samples),
            **_lights(staged),
            **_room(staged, rng),
            **person,
        }
    )
    light = np.array(mitsuba.render(linear, spp=samples, seed=case.seed), dtype=np.float64)
    return light[..., :3], _labels(staged, meshes, person)


def _labels(
    staged: Staged, meshes: Sequence[PersonMesh], person: Mapping[str, Any]
) -> UInt8[np.ndarray, "h w"]:
    """By the first triangle that a ray through a pixel's centre meets."""
    sensor = _sensor(staged, 1)
    sensor["film"]["rfilter"] = {"type": "box"}
    sensor["sampler"] = {"type": "stratified", "sample_count": 1, "jitter": False}
    told = {"type": "aov", "aovs": "depth:depth,triangle:prim_index"}
    labels = np.zeros((staged.camera.height, staged.camera.width), dtype=np.uint8)
    nearest = np.full(labels.shape, np.inf)
    # One mesh at a time: which triangle is met is then told by its number alone.
    for mesh, shape in zip(meshes, person.values(), strict=True):
        scene: Any = mitsuba.load_dict(
            {"type": "scene", "integrator": told, "sensor": sensor, "shape": shape}
        )
        met = np.array(mitsuba.render(scene, spp=1), dtype=np.float64)
        depth, triangle = met[..., -2], np.rint(met[..., -1]).astype(int)
        before = (depth > 0.0) & (depth < nearest)
        nearest[before] = depth[before]
        labels[before] = mesh.labels[mesh.triangles[triangle[before], 0]]
    return labels


def _choose_variant() -> None:
    """``llvm_ad_rgb``, several times faster, where ``DRJIT_LIBLLVM_PATH`` names an LLVM library of
    version 19 or later, such as a Rust toolchain's own, else ``scalar_rgb``.

    Pictures of both differ by the noise of their paths alone.
    """
    if mitsuba.variant() is None:
        mitsuba.set_variant("llvm_ad_rgb" if LLVM_LIBRARY in os.environ else "scalar_rgb")


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
    ambient = {"type": "rgb", "value": list(lighting.ambient)}
    lights: dict[str, Any] = {"ambient": {"type": "constant", "radiance": ambient}}
    for name, lamp in (("lamp", lighting.lamp), ("second", lighting.second)):
        if lamp is not None:
            # A white surface that faces a sphere of radiance L and radius r at distance d gets
            # L r²/d².
            radiance = lamp.strength * (lamp.distance_m / lamp.radius_m) ** 2
            lights[name] = {
                "type": "sphere",
                "center": lamp_place(staged, lamp).tolist(),
                "radius": lamp.radius_m,
                "emitter": {"type": "area", "radiance": {"type": "rgb", "value": radiance}},
            }
    return lights


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


def _shape(mesh: PersonMesh) -> Any:
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
