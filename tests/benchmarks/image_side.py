"""Times of the image side of the fit; run with ``python -m tests.benchmarks.image_side``.

Prints the median processor time of many calls on one thread, for a figure of 20,480 triangles that
fills most of a 640x480 picture. Figures are printed, not asserted: machines differ. Processor time,
because a busy machine stretches the wall clock.
"""

import io
import time
from collections.abc import Callable

import numpy as np
import trimesh
from PIL import Image as PillowImage

from fitter.evidence.edge_cost import edge_cost_map
from fitter.evidence.intensity import intensity_map
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.numerics.mesh_topology import mesh_topology
from fitter.observation.colour import linear_from_display, luminance_of
from fitter.observation.observation import observe
from fitter.parameters import Light, Reflectance
from fitter.render.camera import Camera
from fitter.render.contours import model_edges
from fitter.render.rasterizer import Rendering, render, shade_image
from fitter.render.reflectance import shade, shade_with_derivatives
from fitter.render.shadow import cast_shadow
from fitter.request import Click, View
from fitter.segmentation.grabcut import segment
from fitter.segmentation.trimap import first_band, trimap
from fitter.vocabulary.choices import LightKind

PIXELS = 20_000_000
CENTRE = np.array([0.0, 0.0, 3.2])
LIGHT = Light(kind=LightKind.POINT, azimuth=0.5, elevation=0.4, distance=3.0)
CAMERA = Camera(focal_length_px=800, centre_x=320, centre_y=240, width=640, height=480)


def milliseconds(action: Callable[[], object], *, repeats: int = 30) -> float:
    action()
    times: list[float] = []
    for _ in range(repeats):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return 1e3 * float(np.median(times))


def report(actions: dict[str, Callable[[], object]]) -> None:
    for name, action in actions.items():
        print(f"{name:32s}{milliseconds(action):9.3f} ms")


def rendering_side(vertices: np.ndarray, triangles: np.ndarray) -> Rendering:
    rendering = render(vertices, triangles, CAMERA)
    topology = mesh_topology(triangles, vertex_count=len(vertices))
    visible = rendering.vertex_visible
    points, normals = vertices[visible], rendering.vertex_normals[visible]
    reflectance = Reflectance(
        albedo=np.full(len(points), 0.5),
        specularity=np.full(len(points), 0.2),
        ambient=0.1,
        specular_exponent=10.0,
    )
    print(
        f"{len(triangles)} triangles over {rendering.silhouette.mean():.0%} of 640x480, "
        f"{len(points)} visible vertices"
    )
    report(
        {
            "render": lambda: render(vertices, triangles, CAMERA),
            "model edges": lambda: model_edges(rendering, topology),
            "shade": lambda: shade(
                points, normals, light=LIGHT, body_centre=CENTRE, reflectance=reflectance
            ),
            "shade with derivatives": lambda: shade_with_derivatives(
                points, normals, light=LIGHT, body_centre=CENTRE, reflectance=reflectance
            ),
            "picture of vertex values": lambda: shade_image(rendering, vertices[:, 2]),
            "cast shadow": lambda: cast_shadow(
                vertices, triangles, light=LIGHT, body_centre=CENTRE
            ),
        }
    )
    return rendering


def picture_side(rendering: Rendering) -> None:
    random = np.random.default_rng(0)
    skin = shade_image(rendering, 0.5 - 0.3 * rendering.vertex_normals[:, 2])
    grey = np.where(rendering.silhouette, skin, 0.25) + 0.02 * random.normal(size=skin.shape)
    display = np.clip(grey[..., None] * [1.0, 0.9, 0.8], 0, 1).astype(np.float32)
    luminance = luminance_of(linear_from_display(display))
    mask = rendering.silhouette
    # As far off as a first body is: the true silhouette, moved.
    guess = np.roll(mask, (8, -6), axis=(0, 1))
    no_bones = np.zeros((0, 2, 2))
    band = first_band(guess, no_bones)
    labels = trimap(guess, no_bones, band=band)
    report(
        {
            "tri-map": lambda: trimap(guess, no_bones, band=band),
            "GrabCut": lambda: segment(display, labels),
            "silhouette evidence": lambda: silhouette_evidence(mask),
            "edge cost map": lambda: edge_cost_map(display, threshold_px=12.0),
            "intensity map": lambda: intensity_map(luminance, display, mask),
        }
    )


def observation_side() -> None:
    for width, height in ((640, 480), (3000, 4000)):
        rows, columns = np.mgrid[:height, :width]
        waves = [np.sin(rows / 37) * np.sin(columns / period) for period in (29, 31, 43)]
        pixels = (128 + 100 * np.stack(waves, axis=-1)).astype(np.uint8)
        stream = io.BytesIO()
        PillowImage.fromarray(pixels).save(stream, "JPEG", quality=90)
        names = ("shoulder", "elbow", "hip", "knee")
        clicks = {
            f"{side}_{name}": Click(x=width * x, y=height * (0.2 + 0.15 * row))
            for side, x in (("left", 0.6), ("right", 0.4))
            for row, name in enumerate(names)
        }
        view = View(image=stream.getvalue(), clicks=clicks)
        name = f"observe {width}x{height} JPEG"
        taken = milliseconds(lambda v=view: observe(v, max_pixels=PIXELS), repeats=5)
        print(f"{name:32s}{taken:9.3f} ms")


def main() -> None:
    # In a fit larger arrays than pictures come and go, and glibc learns from the first one freed
    # to keep such blocks; until then each rendering pays 1.1 ms for page faults.
    np.ones(3_500_000)
    mesh = trimesh.creation.icosphere(subdivisions=5)
    vertices = np.array(mesh.vertices) * [0.5, 0.95, 0.4] + CENTRE
    rendering_side(np.array(mesh.vertices) * [1.25, 0.95, 1.0] + CENTRE, np.array(mesh.faces))
    picture_side(render(vertices, np.array(mesh.faces), CAMERA))
    observation_side()


if __name__ == "__main__":
    main()
