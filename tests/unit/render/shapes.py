"""Bodies of known form in the camera frame, for closed-form tests."""

import numpy as np
import trimesh

from fitter.render.camera import Camera


def sphere(
    radius: float, centre: tuple[float, float, float], *, subdivisions: int = 4
) -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)
    return np.array(mesh.vertices) + np.array(centre), np.array(mesh.faces, dtype=np.int32)


def box(
    extents: tuple[float, float, float],
    centre: tuple[float, float, float],
    *,
    rotation: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.box(extents=extents)
    vertices = np.array(mesh.vertices)
    if rotation is not None:
        vertices = vertices @ rotation.T
    return vertices + np.array(centre), np.array(mesh.faces, dtype=np.int32)


def together(*meshes: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    vertices: list[np.ndarray] = []
    triangles: list[np.ndarray] = []
    offset = 0
    for mesh_vertices, mesh_triangles in meshes:
        vertices.append(mesh_vertices)
        triangles.append(mesh_triangles + offset)
        offset += len(mesh_vertices)
    return np.concatenate(vertices), np.concatenate(triangles).astype(np.int32)


def camera(*, width: int = 320, height: int = 240, focal_length_px: float = 400.0) -> Camera:
    return Camera(
        focal_length_px=focal_length_px,
        centre_x=width / 2,
        centre_y=height / 2,
        width=width,
        height=height,
    )
