"""Every file a fit gives back but the result itself."""

from functools import lru_cache

from fitter.arrays import PerVertex
from fitter.body.model import BodyModel
from fitter.export.antialiasing import render_finely, vertex_pictures
from fitter.export.display import png
from fitter.export.gltf import body_canonical_glb, body_posed_glb, lit_vertices
from fitter.export.pictures import (
    drawing_camera,
    drawing_picture,
    drawing_pixels,
    mask_levels,
    overlay_picture,
    trimap_levels,
)
from fitter.export.views import views_picture
from fitter.numerics.mesh_topology import MeshTopology, mesh_topology
from fitter.observation.decoding import decode_picture
from fitter.render.reflectance import shading_terms
from fitter.result import FitResult, PictureFit, before_shading


def artifacts(result: FitResult, *, model: BodyModel, image: bytes) -> dict[str, bytes]:
    """Files by name.

    Always ``body_posed.glb``, ``body_canonical.glb``, ``segmentation.png``, ``overlay.png`` and
    ``views.png``; ``trimap.png`` where the caller sent no mask; ``albedo.png``, ``shading.png``
    and ``shading_lambertian.png`` where shading was used (Fig. 7), and then the bodies before it,
    ``body_posed_se.glb`` and ``body_canonical_se.glb``, to compare SE with SES (section 6).

    Parameters
    ----------
    result
        Of the fit.
    model
        The body model it was fitted with.
    image
        The caller's encoded picture.
    """
    triangles = model.triangles
    camera = drawing_camera(result.person.camera)
    lit = lit_vertices(result.found, model)
    files = {
        "body_posed.glb": body_posed_glb(result.found, model, lit=lit),
        "body_canonical.glb": body_canonical_glb(result, model),
        "segmentation.png": png(mask_levels(result.pictures.segmentation, result.camera, camera)),
        "overlay.png": overlay_png(result.found, model=model, image=image),
        "views.png": png(
            views_picture(
                posed_vertices=result.found.posed_vertices,
                root=result.person.body.translation,
                tilt=result.person.tilt,
                canonical_vertices=result.canonical_vertices,
                triangles=triangles,
            )
        ),
    }
    if result.pictures.trimap is not None:
        files["trimap.png"] = png(trimap_levels(result.pictures.trimap, result.camera, camera))
    files |= _reflectance_pictures(result.found, model, lit)
    outlined = before_shading(result)
    if outlined is not None:
        files["body_posed_se.glb"] = body_posed_glb(outlined.found, model)
        files["body_canonical_se.glb"] = body_canonical_glb(outlined, model)
    return files


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


def _reflectance_pictures(
    found: PictureFit, model: BodyModel, lit: PerVertex | None
) -> dict[str, bytes]:
    """Fig. 7: albedo, the Lambertian part of Eq. 1, and all of it, as the camera sees them.

    With surroundings where the light has them, and then with cast shadows.
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
        lit=lit,
    )
    lambertian = reflectance.ambient + reflectance.albedo * terms.diffuse
    colour = found.person.albedo_rgb
    values = {
        "albedo.png": reflectance.albedo if colour is None else colour,
        "shading_lambertian.png": lambertian,
        "shading.png": lambertian + reflectance.specularity * terms.specular,
    }
    pictures = vertex_pictures(list(values.values()), fine)
    return {name: png(picture) for name, picture in zip(values, pictures, strict=True)}
