"""Every file a fit gives back but the result itself."""

import json
from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from jaxtyping import UInt8

from fitter.arrays import Shape, Vertices
from fitter.body.model import BodyModel
from fitter.export.antialiasing import render_finely, vertex_pictures
from fitter.export.display import png
from fitter.export.gltf import body_canonical_glb, body_posed_glb
from fitter.export.pictures import (
    drawing_camera,
    drawing_picture,
    drawing_pixels,
    mask_levels,
    overlay_picture,
    trimap_levels,
)
from fitter.export.views import views_picture
from fitter.measurement.anthropometry import MeasuringBody, tape_lines
from fitter.numerics.meshes import MeshTopology, mesh_topology
from fitter.observation.decoding import decode_picture
from fitter.render.reflectance import shading_terms
from fitter.result import FitResult, FittedView, PictureFit, before_shading


def result_files(
    result: FitResult, *, model: BodyModel, images: Sequence[bytes]
) -> dict[str, bytes]:
    """Files by name.

    Always ``body_canonical.glb``, and of each picture ``body_posed.glb``, ``segmentation.png``,
    ``overlay.png`` and ``views.png``; ``trimap.png`` where the caller sent no mask; ``albedo.png``,
    ``shading.png`` and ``shading_lambertian.png`` where shading was used (Fig. 7), and then the
    bodies before it, ``body_posed_se.glb`` and ``body_canonical_se.glb``, to compare SE with SES
    (section 6). The names of what belongs to a picture begin with its place in the request:
    ``views/0/overlay.png``.

    Parameters
    ----------
    result
        Of the fit.
    model
        The body model it was fitted with.
    images
        The caller's encoded pictures, in the order of the request.
    """
    files = {"body_canonical.glb": body_canonical_glb(result, model)}
    outlined = before_shading(result)
    if outlined is not None:
        files["body_canonical_se.glb"] = body_canonical_glb(outlined, model)
    for number, (view, image) in enumerate(zip(result.views, images, strict=True)):
        of_view = _files_of(view, model, image)
        if outlined is not None:
            of_view["body_posed_se.glb"] = body_posed_glb(outlined.views[number].found, model)
        files |= {f"views/{number}/{name}": content for name, content in of_view.items()}
    return files


def _files_of(view: FittedView, model: BodyModel, image: bytes) -> dict[str, bytes]:
    found, person = view.found, view.found.person
    camera = drawing_camera(person.camera)
    files = {
        "body_posed.glb": body_posed_glb(found, model),
        "segmentation.png": png(mask_levels(view.pictures.segmentation, view.camera, camera)),
        "overlay.png": overlay_png(found, model=model, image=image),
        "views.png": png(
            views_picture(
                found.posed_vertices, person.body.translation, person.tilt, model.triangles
            )
        ),
    }
    if view.pictures.trimap is not None:
        files["trimap.png"] = png(trimap_levels(view.pictures.trimap, view.camera, camera))
    return files | {
        name: png(picture) for name, picture in reflectance_pictures(found, model).items()
    }


def overlay_png(found: PictureFit, *, model: BodyModel, image: bytes) -> bytes:
    """``overlay.png``: the body's outline over the caller's encoded picture."""
    image_camera = found.person.camera
    camera = drawing_camera(image_camera)
    picture = decode_picture(
        image,
        field="image",
        max_pixels=image_camera.width * image_camera.height,
        enough_pixels=drawing_pixels(image_camera),
    )
    drawn = drawing_picture(picture.pixels, image_camera, camera, reduction=picture.reduction)
    return png(
        overlay_picture(drawn, found.posed_vertices, model.triangles, _topology(model), camera)
    )


@lru_cache(maxsize=2)
def _topology(model: BodyModel) -> MeshTopology:
    return mesh_topology(model.triangles, vertex_count=len(model.mean_vertices))


def reflectance_pictures(
    found: PictureFit, model: BodyModel
) -> dict[str, UInt8[np.ndarray, "h w 3"]]:
    """Fig. 7 by files' names: albedo, the Lambertian part of Eq. 1, and all of it.

    As the camera sees them; none without shading.
    """
    light, reflectance = found.person.light, found.person.reflectance
    if light is None or reflectance is None:
        return {}
    fine = render_finely(found.posed_vertices, model.triangles, drawing_camera(found.person.camera))
    terms = shading_terms(
        found.posed_vertices,
        fine.rendering.vertex_normals,
        light=light,
        body_centre=found.person.body.translation,
        specular_exponent=reflectance.specular_exponent,
    )
    lambertian = reflectance.ambient + reflectance.albedo * terms.diffuse
    colour = found.person.albedo_rgb
    values = {
        "albedo.png": reflectance.albedo if colour is None else colour,
        "shading_lambertian.png": lambertian,
        "shading.png": lambertian + reflectance.specularity * terms.specular,
    }
    return dict(zip(values, vertex_pictures(list(values.values()), fine), strict=True))


DECIMALS = 4
"""Decimal places of a metre: a tenth of a millimetre."""


def tapes_json(result: FitResult, measuring: MeasuringBody) -> bytes:
    """The lines of a fit's body; see :func:`tapes_of`."""
    return tapes_of(result.canonical_vertices, result.person.body.shape, measuring)


def tapes_of(canonical_vertices: Vertices, shape: Shape, measuring: MeasuringBody) -> bytes:
    """Lines by the measurements' names, in the frame of ``body_canonical.glb`` (feet on y = 0).

    Parameters
    ----------
    canonical_vertices
        (m, 3) body frame, metres.
    shape
        (n,) coefficients of that body.
    measuring
        The body it was measured with.
    """
    lowest = float(canonical_vertices[:, 1].min())
    lines = {
        name: (line - [0.0, lowest, 0.0]).round(DECIMALS).tolist()
        for name, line in tape_lines(measuring, shape).items()
    }
    document = {"frame": "metres, +y up", "lines": lines}
    return json.dumps(document, separators=(",", ":")).encode()
