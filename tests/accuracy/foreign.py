"""Pictures of bodies by another maker, with truth: beside the repository, and not in it.

Their measurements are named as the suite's where both mean the same; the hip is compared at the
seat. Levels are a matter of definition, most of all the navel's.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from PIL import Image as PillowImage

from fitter.parameters import Light
from fitter.request import Click, FitRequest
from fitter.vocabulary.choices import Gender, LightKind
from tests.accuracy.people import packaged_model
from tests.accuracy.scene import Half, Series
from tests.accuracy.true_picture import VISIBLE, TruePicture
from tests.accuracy.truth import MOVED_PARTS, TrueBody, light_toward, part_of_joint
from tests.one_picture import one_picture
from tests.shared_data import NOT_SHIPPED, SHARED_DATA

FOLDER = SHARED_DATA / "foreign"

MISSING = f"no foreign pictures: they need ../shared/data/foreign, {NOT_SHIPPED}"

FIRST_REPORTED = "g21"
"""Constants may be chosen on the pictures before; from this one on they are reported."""

TRUE_NAMES: Mapping[str, str] = {
    "chest_girth": "chest_cm",
    "waist_girth_smallest": "waist_min_cm",
    "hip_girth": "hip_seat_cm",
    "weight": "weight_kg",
    "waist_girth_navel": "waist_navel_cm",
}


def foreign_names(half: Half | None = None) -> list[str]:
    """The pictures of a half, or all; none where they are not beside the repository."""
    names = sorted(path.name for path in FOLDER.glob("g*"))
    return [each for each in names if half is None or foreign_half(each) is half]


def foreign_half(name: str) -> Half:
    """The half a picture belongs to."""
    return Half.REPORTING if name >= FIRST_REPORTED else Half.TUNING


def foreign_picture(name: str, folder: Path = FOLDER) -> TruePicture:
    """Read a picture of this name; a person's views from front and side end in ``f`` and ``s``."""
    files = folder / name
    truth = json.loads((files / "truth.json").read_text())
    mask = np.asarray(PillowImage.open(files / "mask.png").convert("L")) > 127
    request = _request(
        (files / "image.jpg").read_bytes(), json.loads((files / "request.json").read_text())
    )
    joints = _joints(truth["joints_camera_m"], request.person.gender)
    with np.load(files / "bodies.npz", allow_pickle=False) as bodies:
        body = TrueBody(
            canonical=bodies["rest_m"].astype(np.float64),
            triangles=bodies["faces"],
            measurements={
                ours: truth["measurements"][theirs]["value"] for ours, theirs in TRUE_NAMES.items()
            },
            stature_m=truth["stature_m"]["value"],
        )
    return TruePicture(
        name=name,
        person=name.rstrip("fs"),
        series=Series.FOREIGN,
        half=foreign_half(name),
        request=request,
        # Hair and clothes are colour without thickness.
        body_mask=mask,
        person_mask=mask,
        focal_length_px=truth["focal_length"]["px"],
        light=_light(truth, joints),
        joints=joints,
        truth=body,
    )


def _request(image: bytes, options: Mapping[str, Any]) -> FitRequest:
    return one_picture(
        image=image,
        clicks={name: _click(each) for name, each in options["points"].items()},
        gender=Gender(options["gender"]),
        height_m=options["height_m"],
        focal_length_px=options.get("focal_length_px"),
        focal_length_35mm=options.get("focal_length_35mm"),
        force=True,
    )


def _click(point: Any) -> Click:
    if isinstance(point, Mapping):
        return Click(
            x=point["x"], y=point["y"], occluded=point.get("visibility", VISIBLE) < VISIBLE
        )
    x, y, *visibility = point
    return Click(x=x, y=y, occluded=bool(visibility) and visibility[0] < VISIBLE)


def _joints(
    true: Mapping[str, tuple[float, float, float]], gender: Gender
) -> Float[np.ndarray, "p 3"]:
    joints = np.full((len(packaged_model(gender).part_names), 3), np.nan)
    for name, place in true.items():
        if name.split("_")[-1] in MOVED_PARTS:
            joints[part_of_joint(name)] = place
    return joints


def _light(truth: Mapping[str, Any], joints: Float[np.ndarray, "p 3"]) -> Light:
    """The one light of a picture, as seen from the hips' middle."""
    (light,) = truth["light"]["lights"]
    if "travels_camera" in light:
        return light_toward(-np.array(light["travels_camera"]), LightKind.DIRECTIONAL)
    hips = joints[[part_of_joint("left_hip"), part_of_joint("right_hip")]].mean(axis=0)
    return light_toward(np.array(light["position_camera_m"]) - hips, LightKind.POINT)
