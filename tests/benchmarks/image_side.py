"""Times of the image side of the fit; run with ``python -m tests.benchmarks.image_side``.

Prints the median of many calls on one thread at 640x480. Figures are printed, not asserted:
machines differ, and a busy one says nothing.
"""

import time
from collections.abc import Callable

import numpy as np
import trimesh

from fitter.camera import Camera
from fitter.numerics.mesh_topology import mesh_topology
from fitter.parameters import Light, LightKind, Reflectance
from fitter.render.contours import model_edges
from fitter.render.interpolation import shade_image
from fitter.render.rasterizer import render
from fitter.render.reflectance import shade, shade_with_derivatives
from fitter.render.shadow import cast_shadow


def milliseconds(action: Callable[[], object], *, repeats: int = 50) -> float:
    action()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return 1e3 * float(np.median(times))


def main() -> None:
    mesh = trimesh.creation.icosphere(subdivisions=5)
    vertices = np.array(mesh.vertices) * [1.25, 0.95, 1.0] + [0, 0, 3.2]
    triangles = np.array(mesh.faces, dtype=np.int32)
    camera = Camera(focal_length_px=800, centre_x=320, centre_y=240, width=640, height=480)
    rendering = render(vertices, triangles, camera)
    topology = mesh_topology(triangles, vertex_count=len(vertices))
    visible = rendering.vertex_visible
    light = Light(kind=LightKind.POINT, azimuth=0.5, elevation=0.4, distance=3.0)
    centre = np.array([0.0, 0.0, 3.2])
    reflectance = Reflectance(
        albedo=np.full(visible.sum(), 0.5),
        specularity=np.full(visible.sum(), 0.2),
        ambient=0.1,
        specular_exponent=10.0,
    )
    points, normals = vertices[visible], rendering.vertex_normals[visible]
    print(f"{len(triangles)} triangles, {visible.sum()} visible vertices")
    actions: dict[str, Callable[[], object]] = {
        "render": lambda: render(vertices, triangles, camera),
        "model edges": lambda: model_edges(rendering, topology),
        "shade": lambda: shade(
            points, normals, light=light, body_centre=centre, reflectance=reflectance
        ),
        "shade with derivatives": lambda: shade_with_derivatives(
            points, normals, light=light, body_centre=centre, reflectance=reflectance
        ),
        "picture of vertex values": lambda: shade_image(rendering, vertices[:, 2]),
        "cast shadow": lambda: cast_shadow(vertices, triangles, light=light, body_centre=centre),
    }
    for name, action in actions.items():
        print(f"{name:28s}{milliseconds(action):8.3f} ms")


if __name__ == "__main__":
    main()
