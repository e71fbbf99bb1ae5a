"""What a fit takes for skin and for cloth, by pixel, against what a picture shows."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import UInt8

from fitter.arrays import Mask
from fitter.body.model import regress
from fitter.fits.clothing import FACE_CLICKS
from fitter.observation.pixels import linear_from_display
from fitter.render.rasterizer import render
from fitter.request import View
from fitter.result import FitResult
from fitter.segmentation.coverage import coverage
from fitter.segmentation.skin_colour import PersonRegions, face_point, nearest_part, skin_map
from fitter.vocabulary.choices import BodyRegion, Covering
from tests.accuracy.people import packaged_model
from tests.accuracy.scene import Label
from tests.accuracy.scoring import resampled, working_scale

UPPER_PARTS = frozenset({"chest", "spine", "neck", "head", "arm", "forearm", "hand"})
"""Cloth on other parts, but for feet, belongs to what covers the lower body."""

CLASSES: Mapping[str, frozenset[int]] = {
    "person": frozenset(Label) - {Label.BACKGROUND},
    "skin": frozenset({Label.SKIN}),
    "hair": frozenset({Label.HAIR}),
    "cloth": frozenset({Label.UPPER, Label.LOWER, Label.SHOES}),
    "upper": frozenset({Label.UPPER}),
    "lower": frozenset({Label.LOWER}),
    "shoes": frozenset({Label.SHOES}),
}

Labels = UInt8[np.ndarray, "h w"]


def seen_labels(result: FitResult, asked: View, shape: tuple[int, ...]) -> Labels:
    """Labels (h, w) by the code that tells a fit where skin shows, given the body it found.

    Shoes are feet that the fit calls covered. Of people taken to be in underwear all is bare.
    """
    view = result.views[0]
    model = packaged_model(result.person.gender)
    shown = render(view.found.posed_vertices, model.triangles, view.camera)
    faces = shown.face_ids
    regions = PersonRegions(
        person=view.pictures.segmentation,
        parts=np.where(faces >= 0, model.part_of_triangle[faces], -1),
        part_names=model.part_names,
        face=face_point(_clicked_face(result, asked), _nose(result)),
        pixels_per_metre=view.camera.focal_length_px / float(shown.vertices[:, 2].mean()),
    )
    skin = skin_map(linear_from_display(view.pictures.image), regions)
    covered = coverage(skin, regions, model.gender)
    bare = regions.person & (covered.bare(skin, regions) > 0.5)
    kinds = np.array([name.rpartition("_")[2] for name in model.part_names])
    kind = kinds[nearest_part(regions)]
    labels = np.where(np.isin(kind, list(UPPER_PARTS)), Label.UPPER, Label.LOWER)
    shod = {each.region: each.kind for each in view.found.clothing}
    if shod.get(BodyRegion.FEET, Covering.BARE) is not Covering.BARE:
        labels[kind == "foot"] = Label.SHOES
    labels[kind == "head"] = Label.HAIR
    labels[bare & ((kind != "head") | skin.coloured)] = Label.SKIN
    labels[~regions.person] = Label.BACKGROUND
    return resampled(labels.astype(np.uint8), working_scale(result), shape)


def label_overlaps(found: Labels, true: Labels) -> dict[str, float | None]:
    """Intersection over union by class; None of what is neither there nor found."""
    overlaps: dict[str, float | None] = {}
    for name, labels in CLASSES.items():
        here, there = (_of(each, labels) for each in (found, true))
        either = int((here | there).sum())
        overlaps[name] = float((here & there).sum() / either) if either and there.any() else None
    return overlaps


def _of(labels: Labels, wanted: frozenset[int]) -> Mask:
    return np.isin(labels, list(wanted))


def _clicked_face(result: FitResult, asked: View) -> np.ndarray:
    """In working pixels."""
    found = [asked.clicks.get(name) for name in FACE_CLICKS]
    places = [(each.x, each.y) for each in found if each is not None and not each.occluded]
    return working_scale(result) * np.array(places).reshape(-1, 2)


def _nose(result: FitResult) -> np.ndarray | None:
    """Of the body found; None outside the picture."""
    view = result.views[0]
    landmarks = packaged_model(result.person.gender).landmarks
    point = regress(landmarks, view.found.posed_vertices)[landmarks.names.index("nose")]
    x, y = view.camera.project(point[None])[0]
    inside = 0 <= x < view.camera.width and 0 <= y < view.camera.height
    return np.array([x, y]) if inside else None
