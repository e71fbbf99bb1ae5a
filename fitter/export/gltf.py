"""The fitted body as glTF 2.0 binary files.

``body_posed.glb`` lies in the camera frame with glTF's axes (OpenCV x diag(1, -1, -1): x right,
y up, looking along -z), metres, so that its camera node is the identity; it carries camera, light,
and reflectance per vertex. Light from all round, where it was found as spherical harmonics, is the
light's extra ``surroundings`` (:mod:`fitter.render.surroundings`, in the file's axes), and what
cast shadows leave of the lamp the vertex attribute ``_LIT``. ``body_canonical.glb`` lies in the
body frame (y up, facing +z) in the canonical pose with its feet on y = 0. Vertex order is the body
model's, in both.
"""

import math
from importlib.metadata import PackageNotFoundError, version

import numpy as np
from jaxtyping import Float

from fitter.arrays import Normals, PerVertex, Triangles, Vector3, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES
from fitter.camera import Camera
from fitter.export.glb import BinaryChunk, Target, pack_glb
from fitter.numerics.normals import summed_cross_products
from fitter.parameters import Light, LightKind, Reflectance
from fitter.render.light import direction_to_light, light_position
from fitter.render.shadow import lamp_seen
from fitter.render.surroundings import GLTF_SIGNS
from fitter.result import FitResult, LitBody

NEUTRAL_ALBEDO = 0.6
"""Base colour where no reflectance was estimated (SE)."""

NEUTRAL_ROUGHNESS = 0.8
NEAR_PLANE_M = 0.01

DIELECTRIC_REFLECTANCE = 0.04
"""glTF's reflectance at normal incidence, which KHR_materials_specular scales."""

COLOUR_PERCENTILE = 99.0
"""Albedo is relative to a light of intensity 1 and may exceed 1, colours may not: colours are
albedo divided by this percentile where it exceeds 1, and the light is made as much stronger."""


def body_posed_glb(result: LitBody, model: BodyModel) -> bytes:
    """The posed body with its camera, light and reflectance."""
    colour_scale = _colour_scale(result.reflectance, result.albedo_rgb)
    document = _document(result, model, name="body_posed")
    lit: PerVertex | None = None
    nodes: list[dict[str, object]] = [
        {"mesh": 0, "name": "body"},
        {"camera": 0, "name": "camera"},
    ]
    document["cameras"] = [_camera(result.image_camera)]
    if result.light is not None and result.reflectance is not None:
        light, placement = light_and_node(
            result.light,
            body_centre=result.body.translation,
            colour_scale=colour_scale,
            reflectance=result.reflectance,
        )
        document["extensions"] = {"KHR_lights_punctual": {"lights": [light]}}
        nodes.append(placement)
        lit = lamp_seen(
            result.posed_vertices,
            model.triangles,
            light=result.light,
            body_centre=result.body.translation,
        )
    return _with_body(
        document,
        nodes,
        vertices=result.posed_vertices * CAMERA_AXES,
        triangles=model.triangles,
        result=result,
        lit=lit,
    )


def body_canonical_glb(result: FitResult, model: BodyModel) -> bytes:
    """The body in the canonical pose, standing on y = 0."""
    lowest = result.canonical_vertices[:, 1].min()
    return _with_body(
        _document(result, model, name="body_canonical"),
        [{"mesh": 0, "name": "body"}],
        vertices=result.canonical_vertices - np.array([0.0, lowest, 0.0]),
        triangles=model.triangles,
        result=result,
    )


def light_and_node(
    light: Light, *, body_centre: Vector3, colour_scale: float, reflectance: Reflectance
) -> tuple[dict[str, object], dict[str, object]]:
    """The light of Eq. 1 for KHR_lights_punctual, and the node that places it.

    Eq. 1 leaves out the 1/π of a Lambertian surface, glTF does not: a surface of albedo a facing
    a light of l = 1 shines a l = (a/π)(π l), so illuminance is π l. A point light attenuated from
    l = 1 at the body's centre, at distance d, is π l d² candela; a directional one π l lux.
    glTF's lights shine along their node's -z.
    """
    extras: dict[str, object] = {
        "azimuth_rad": light.azimuth,
        "elevation_rad": light.elevation,
        "intensity_at_body_centre": 1.0,
        "ambient": reflectance.ambient,
        "specular_exponent": reflectance.specular_exponent,
        "colour_scale": colour_scale,
    }
    if light.surroundings is not None:
        extras["surroundings"] = (GLTF_SIGNS * light.surroundings).tolist()
    to_light = direction_to_light(light) * CAMERA_AXES
    illuminance = math.pi * colour_scale
    node: dict[str, object] = {
        "name": "light",
        "extensions": {"KHR_lights_punctual": {"light": 0}},
    }
    if light.kind is LightKind.POINT:
        node["translation"] = (light_position(light, body_centre) * CAMERA_AXES).tolist()
        intensity = illuminance * light.distance**2
        extras["distance_m"] = light.distance
    else:
        node["rotation"] = quaternion_from_z_to(to_light).tolist()
        intensity = illuminance
    return (
        {
            "type": light.kind.value,
            "name": "light",
            "color": [1.0, 1.0, 1.0],
            "intensity": intensity,
            "extras": extras,
        },
        node,
    )


def quaternion_from_z_to(direction: Vector3) -> Float[np.ndarray, "4"]:
    """The shortest rotation that takes +z to a unit direction, as glTF's (x, y, z, w)."""
    x, y, z = direction
    if z < -1.0 + 1e-12:
        return np.array([1.0, 0.0, 0.0, 0.0])
    quaternion = np.array([-y, x, 0.0, 1.0 + z])
    return quaternion / np.linalg.norm(quaternion)


def generator_name() -> str:
    """The program and its version as glTF's ``asset.generator`` wants them."""
    try:
        return f"Maquette {version('maquette')}"
    except PackageNotFoundError:
        return "Maquette (not installed)"


def _with_body(
    document: dict[str, object],
    nodes: list[dict[str, object]],
    *,
    vertices: Vertices,
    triangles: Triangles,
    result: LitBody,
    lit: PerVertex | None = None,
) -> bytes:
    binary = BinaryChunk()
    add_body_mesh(
        document,
        binary,
        vertices=vertices,
        triangles=triangles,
        reflectance=result.reflectance,
        albedo_rgb=result.albedo_rgb,
        lit=lit,
    )
    document["nodes"] = nodes
    return pack_glb(document, binary)


def add_body_mesh(
    document: dict[str, object],
    binary: BinaryChunk,
    *,
    vertices: Vertices,
    triangles: Triangles,
    reflectance: Reflectance | None,
    albedo_rgb: Vertices | None,
    lit: PerVertex | None = None,
) -> dict[str, object]:
    """Give a document its one mesh, of the body, and its material.

    Parameters
    ----------
    document
        Gets ``meshes``, ``materials`` and ``extensionsUsed``.
    binary
        Gets the arrays.
    vertices, triangles
        The body, in the axes of the file.
    reflectance, albedo_rgb
        Per vertex; a neutral colour where there is none.
    lit
        Per vertex, the share of the lamp that cast shadows leave; where that is known.

    Returns
    -------
    dict
        The mesh's primitive as it stands in the document, to be added to.
    """

    def attribute(values: np.ndarray, *, bounds: bool = False) -> int:
        return binary.add(values.astype(np.float32), target=Target.VERTEX_ATTRIBUTE, bounds=bounds)

    scale = _colour_scale(reflectance, albedo_rgb)
    attributes = {
        "POSITION": attribute(vertices, bounds=True),
        "NORMAL": attribute(unit_normals(vertices, triangles)),
    }
    if reflectance is not None:
        colours = _colours(reflectance, albedo_rgb)
        attributes["COLOR_0"] = attribute(np.clip(colours / scale, 0.0, 1.0))
        attributes["_ALBEDO"] = attribute(reflectance.albedo)
        attributes["_SPECULARITY"] = attribute(reflectance.specularity)
    if lit is not None:
        attributes["_LIT"] = attribute(lit)
    index_type = np.uint16 if len(vertices) < np.iinfo(np.uint16).max else np.uint32
    indices = binary.add(triangles.ravel().astype(index_type), target=Target.TRIANGLE_INDICES)
    material, extensions = _material(reflectance, scale)
    if "extensions" in document:
        extensions = ["KHR_lights_punctual", *extensions]
    if extensions:
        document["extensionsUsed"] = sorted(extensions)
    document["materials"] = [material]
    primitive: dict[str, object] = {"attributes": attributes, "indices": indices, "material": 0}
    document["meshes"] = [{"name": "body", "primitives": [primitive]}]
    return primitive


def unit_normals(vertices: Vertices, triangles: Triangles) -> Normals:
    """Area-weighted unit normals; +z where the triangles round a vertex have none."""
    sums = summed_cross_products(np.ascontiguousarray(vertices), triangles)
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.where(lengths > 0.0, sums / np.maximum(lengths, 1e-30), [0.0, 0.0, 1.0])


def _document(result: LitBody, model: BodyModel, *, name: str) -> dict[str, object]:
    provenance = _provenance(result, model)
    # Blender keeps the scene's extras but drops the asset's, so both carry the provenance.
    return {
        "asset": {"version": "2.0", "generator": generator_name(), "extras": provenance},
        "scene": 0,
        "scenes": [{"name": name, "extras": provenance}],
    }


def _provenance(result: LitBody, model: BodyModel) -> dict[str, object]:
    return {
        "generator": generator_name(),
        "method": "Guan, Weiss, Balan, Black: Estimating Human Shape and Pose from a Single "
        "Image, ICCV 2009",
        "gender": result.gender.value,
        "height_m": result.height_m,
        "cues": result.cues.value,
        "outcome": result.outcome.value,
        "frame": "metres, +y up",
        "body_model": model_provenance(model),
    }


def model_provenance(model: BodyModel) -> dict[str, object]:
    """Which body model it is, and from what it was made under which licences."""
    return {
        "checksum": str(model.header.get("checksum", "")),
        "sources": model.header.get("sources", ""),
        "licences": model.header.get("licences", ""),
    }


def _camera(camera: Camera) -> dict[str, object]:
    return {
        "type": "perspective",
        "name": "camera",
        "perspective": {
            "yfov": 2.0 * math.atan(camera.height / (2.0 * camera.focal_length_px)),
            "aspectRatio": camera.width / camera.height,
            "znear": NEAR_PLANE_M,
        },
        # glTF has no principal point; with it off the middle, these say what yfov cannot.
        "extras": {
            "fx_px": camera.focal_length_px,
            "fy_px": camera.focal_length_px,
            "cx_px": camera.centre_x,
            "cy_px": camera.centre_y,
            "width_px": camera.width,
            "height_px": camera.height,
        },
    }


def _material(
    reflectance: Reflectance | None, colour_scale: float
) -> tuple[dict[str, object], list[str]]:
    """The nearest physically based material to Blinn-Phong, and the extensions it uses.

    Roughness = (2 / (α + 2))^(1/4) gives GGX the width of the lobe (h . n)^α. Its height at the
    mirror direction is F0 / (4 π roughness⁴) = F0 (α + 2) / (8 π); lit by π l it shall be s l, so
    F0 = 8 s / (α + 2), expressed as a multiple of glTF's dielectric 0.04.
    """
    if reflectance is None:
        return {
            "name": "neutral",
            "pbrMetallicRoughness": {
                "baseColorFactor": [NEUTRAL_ALBEDO] * 3 + [1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": NEUTRAL_ROUGHNESS,
            },
        }, []
    exponent = reflectance.specular_exponent
    mean_specularity = float(np.mean(reflectance.specularity)) / colour_scale
    factor = 8.0 * mean_specularity / (exponent + 2.0) / DIELECTRIC_REFLECTANCE
    return {
        "name": "skin",
        "pbrMetallicRoughness": {
            "metallicFactor": 0.0,
            "roughnessFactor": (2.0 / (exponent + 2.0)) ** 0.25,
        },
        "extensions": {"KHR_materials_specular": {"specularColorFactor": [factor] * 3}},
        "extras": {
            "specular_exponent": exponent,
            "ambient": reflectance.ambient,
            "mean_specularity": float(np.mean(reflectance.specularity)),
        },
    }, ["KHR_materials_specular"]


def _colours(reflectance: Reflectance, albedo_rgb: Vertices | None) -> Vertices:
    """Linear red, green and blue albedo per vertex; grey where only luminance was estimated."""
    if albedo_rgb is not None:
        return albedo_rgb
    return np.repeat(reflectance.albedo[:, None], 3, axis=1)


def _colour_scale(reflectance: Reflectance | None, albedo_rgb: Vertices | None) -> float:
    if reflectance is None:
        return 1.0
    return max(1.0, float(np.percentile(_colours(reflectance, albedo_rgb), COLOUR_PERCENTILE)))
