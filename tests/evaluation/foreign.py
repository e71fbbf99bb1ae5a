"""Pictures of bodies by another maker, with truth: beside the repository, and not in it.

Their measurements are named as the suite's where both mean the same; a waist or a seat is compared
at its smallest and largest, because levels are a matter of definition.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from PIL import Image as PillowImage

from fitter.arrays import Mask, Points3D
from fitter.body.skeleton import regress
from fitter.render.rasterizer import render
from fitter.request import Click, Cues, FitRequest, Gender
from fitter.result import FitResult
from fitter.training.articulation.part_tree import part_index
from tests.evaluation.landmark_points import packaged_model
from tests.evaluation.scene import Half
from tests.evaluation.suite import MILLIMETRES, VISIBLE, overlap, resampled, working_scale
from tests.shared_data import SHARED_DATA

FOLDER = SHARED_DATA / "foreign"

FIRST_REPORTED = "g21"
"""Constants may be chosen on the pictures before; from this one on they are reported."""

TRUE_NAMES: Mapping[str, str] = {
    "chest_girth": "chest_cm",
    "waist_girth_smallest": "waist_min_cm",
    "hip_girth": "hip_seat_cm",
    "weight": "weight_kg",
}

_MOVED_PARTS: Mapping[str, str] = {
    "shoulder": "upper_arm", "elbow": "forearm", "wrist": "hand", "hip": "thigh", "knee": "shin",
    "ankle": "foot",
}  # fmt: skip
"""The part that turns about each joint."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ForeignPicture:
    """One picture, what a fit of it is asked, and the truth."""

    name: str
    image: bytes
    request: Mapping[str, Any]
    truth: Mapping[str, Any]
    mask: Mask

    @property
    def measurements(self) -> dict[str, float]:
        """True values by the suite's names, centimetres and kilograms."""
        return {
            ours: self.truth["measurements"][theirs]["value"] for ours, theirs in TRUE_NAMES.items()
        }


def foreign_names(half: Half | None) -> list[str]:
    """The pictures of a half, or all; none where they are not beside the repository."""
    names = sorted(path.name for path in FOLDER.glob("g*"))
    return [each for each in names if half is None or foreign_half(each) is half]


def foreign_half(name: str) -> Half:
    """The half a picture belongs to."""
    return Half.REPORTING if name >= FIRST_REPORTED else Half.TUNING


def read_foreign(name: str) -> ForeignPicture:
    """Read a picture of this name."""
    folder: Path = FOLDER / name
    return ForeignPicture(
        name=name,
        image=(folder / "image.jpg").read_bytes(),
        request=json.loads((folder / "request.json").read_text()),
        truth=json.loads((folder / "truth.json").read_text()),
        mask=np.asarray(PillowImage.open(folder / "mask.png").convert("L")) > 127,
    )


def foreign_request(picture: ForeignPicture, cues: Cues) -> FitRequest:
    """What the service would be asked."""
    options = picture.request
    return FitRequest(
        image=picture.image,
        clicks={name: _click(each) for name, each in options["points"].items()},
        gender=Gender(options["gender"]),
        height_m=options["height_m"],
        focal_length_px=options.get("focal_length_px"),
        focal_length_35mm=options.get("focal_length_35mm"),
        cues=cues,
    )


def foreign_joint_mm(picture: ForeignPicture, result: FitResult) -> float:
    """Mean distance of shoulders to ankles, with both hips' middles together."""
    model = packaged_model(result.person.gender)
    joints = regress(model.joint_regressor, result.found.posed_vertices)
    true = picture.truth["joints_camera_m"]
    names = [name for name in true if name.split("_")[-1] in _MOVED_PARTS]
    found = _about_the_hips({name: joints[_part_of(name)] for name in names})
    told = _about_the_hips({name: np.array(true[name]) for name in names})
    return MILLIMETRES * float(np.linalg.norm(found - told, axis=1).mean())


def foreign_overlaps(picture: ForeignPicture, result: FitResult) -> tuple[float, float]:
    """Intersection over union with the true silhouette: of the body, and of the segmentation."""
    body = render(
        result.found.posed_vertices,
        packaged_model(result.person.gender).triangles,
        result.person.camera,
    ).silhouette
    cut = resampled(result.pictures.segmentation, working_scale(result), picture.mask.shape)
    return overlap(body, picture.mask), overlap(cut, picture.mask)


def _click(point: Any) -> Click:
    if isinstance(point, Mapping):
        return Click(
            x=point["x"], y=point["y"], occluded=point.get("visibility", VISIBLE) < VISIBLE
        )
    x, y, *visibility = point
    return Click(x=x, y=y, occluded=bool(visibility) and visibility[0] < VISIBLE)


def _part_of(joint: str) -> int:
    side, name = joint.split("_")
    return part_index(f"{side}_{_MOVED_PARTS[name]}")


def _about_the_hips(joints: Mapping[str, Float[np.ndarray, "3"]]) -> Points3D:
    middle = 0.5 * (joints["left_hip"] + joints["right_hip"])
    return np.array([each - middle for each in joints.values()])
