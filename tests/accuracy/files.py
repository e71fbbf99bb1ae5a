"""A case's files: picture, request, truth and masks, written by the generator."""

import io
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image as PillowImage

from fitter.arrays import Mask
from fitter.parameters import Light
from fitter.vocabulary.choices import LightKind
from tests.accuracy.clicks import hidden_points, noisy_clicks
from tests.accuracy.scene import PAIRED_SERIES, Case, FocalLength, Label
from tests.accuracy.staging import Staged, rendering, root_joint
from tests.accuracy.truth import true_body, true_joints, true_light

PICTURES_FOLDER = Path(__file__).parent / "data" / "pictures"

LABEL_COLOURS = (
    (0, 0, 0),
    (230, 170, 130),
    (90, 50, 20),
    (60, 120, 220),
    (60, 170, 80),
    (220, 60, 60),
)
"""Of background, skin, hair, upper and lower garment, shoes."""

FOCAL_LENGTH_IN_35MM_FILM = 0xA405
EXIF_DIRECTORY = 0x8769
ARTIST, COPYRIGHT = 0x013B, 0x8298

SHOT_NOISE = 0.00012
READ_NOISE = 0.0015
"""Variance of linear light per unit of light, and deviation in the dark: a few grey levels."""

Labels = UInt8[np.ndarray, "h w"]

CREDITS = (
    "Our own render with Mitsuba 3 of a body made from MakeHuman's CC0 assets; released under "
    "CC0 1.0. Nobody real is shown."
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CaseFiles:
    """What the suite reads of a case."""

    image: bytes
    document: dict[str, Any]
    body_mask: Mask
    person_mask: Mask
    labels: Labels | None

    @property
    def request(self) -> dict[str, Any]:
        """The options of the fit."""
        return self.document["request"]

    @property
    def scene(self) -> dict[str, Any]:
        """Light, camera and joints, which a request does not tell, and hidden points."""
        return self.document["scene"]


def write_picture(
    folder: Path, staged: Staged, linear: np.ndarray, labels: Labels, *, quality: int
) -> None:
    """The photograph and the masks of body and person; of people in clothes, labels too."""
    folder.mkdir(parents=True, exist_ok=True)
    case = staged.case
    in_exif = case.focal_length is FocalLength.EXIF
    picture = photograph(
        linear,
        quality=quality,
        equivalent_mm=case.view.equivalent_mm if in_exif else None,
        rng=np.random.default_rng([case.seed, 1]),
    )
    (folder / f"{case.name}.jpg").write_bytes(picture)
    body = rendering(staged).silhouette
    (folder / f"{case.name}_body.png").write_bytes(encoded_mask(body))
    (folder / f"{case.name}_person.png").write_bytes(encoded_mask(labels > Label.BACKGROUND))
    if case.outfit is not None:
        write_labels(folder / f"{case.name}_labels.png", labels)


def write_labels(path: Path, labels: Labels) -> None:
    """What each pixel shows, as a PNG with a palette."""
    picture = PillowImage.fromarray(labels).convert("P")
    picture.putpalette([value for colour in LABEL_COLOURS for value in colour])
    picture.save(path, optimize=True)


def read_labels(path: Path) -> Labels:
    """What each pixel shows."""
    with PillowImage.open(path) as picture:
        return np.asarray(picture)


def write_document(folder: Path, staged: Staged) -> None:
    """Request and truth, as JSON; needs no renderer."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{staged.case.name}.json"
    path.write_text(json.dumps(document(staged), indent=1) + "\n")


def document(staged: Staged) -> dict[str, object]:
    """Request and truth of a case."""
    return {
        "request": request_of(staged),
        "truth": true_measurements(staged),
        "scene": _scene_document(staged),
        "credits": CREDITS,
    }


def _scene_document(staged: Staged) -> dict[str, object]:
    """What a request does not tell; of pairs, whose sides hide half the body, also which points."""
    scene: dict[str, object] = {
        "person": staged.case.person,
        "light": _light_document(true_light(staged)),
        "focal_length_px": round(staged.camera.focal_length_px, 3),
        "root_joint_m": _rounded(staged.in_camera(root_joint(staged))),
        "joints_m": [_rounded(joint) for joint in true_joints(staged)],
    }
    outfit = staged.case.outfit
    if outfit is not None:
        scene["clothes"] = {"class": outfit.name, "sole_m": outfit.sole_m}
    if staged.case.series in PAIRED_SERIES:
        scene["hidden_points"] = hidden_points(staged, rendering(staged))
    return scene


def request_of(staged: Staged) -> dict[str, object]:
    """The options of a fit: clicks, gender, height, and the focal length if it is given."""
    case = staged.case
    clicks = noisy_clicks(staged, rendering(staged), np.random.default_rng([case.seed, 2]))
    request: dict[str, object] = {
        "gender": staged.person.gender.value,
        "height_m": round(true_measurements(staged)["stature"] / 100.0, 3),
        "points": clicks,
    }
    if case.focal_length is FocalLength.GIVEN:
        request["focal_length_px"] = round(staged.camera.focal_length_px, 2)
    return request


def true_measurements(staged: Staged) -> dict[str, float]:
    """Measurements of the true body by name, centimetres and kilograms."""
    return {name: round(value, 2) for name, value in true_body(staged.person).measurements.items()}


def read_case(case: Case, folder: Path = PICTURES_FOLDER) -> CaseFiles:
    """Read what the generator wrote."""
    return CaseFiles(
        image=(folder / f"{case.name}.jpg").read_bytes(),
        document=json.loads((folder / f"{case.name}.json").read_text()),
        body_mask=_load_mask(folder / f"{case.name}_body.png"),
        person_mask=_load_mask(folder / f"{case.name}_person.png"),
        labels=None if case.outfit is None else read_labels(folder / f"{case.name}_labels.png"),
    )


def light_from_document(values: dict[str, Any]) -> Light:
    """The light that :func:`document` wrote."""
    return Light(
        kind=LightKind(values["kind"]),
        azimuth=float(np.radians(values["azimuth_deg"])),
        elevation=float(np.radians(values["elevation_deg"])),
        distance=values["distance_m"],
    )


def _light_document(light: Light) -> dict[str, Any]:
    return {
        "kind": light.kind.value,
        "azimuth_deg": round(float(np.degrees(light.azimuth)), 3),
        "elevation_deg": round(float(np.degrees(light.elevation)), 3),
        "distance_m": round(light.distance, 4),
    }


def _rounded(point: np.ndarray) -> list[float]:
    return [round(float(value), 5) for value in point]


def encoded_mask(mask: Mask) -> bytes:
    """A mask as a request carries it: a PNG."""
    stream = io.BytesIO()
    PillowImage.fromarray(mask).save(stream, "PNG", optimize=True)
    return stream.getvalue()


def _load_mask(path: Path) -> Mask:
    with PillowImage.open(path) as picture:
        return np.asarray(picture.convert("L")) > 127


def photograph(
    linear: Float[np.ndarray, "h w 3"],
    *,
    quality: int,
    equivalent_mm: int | None,
    rng: np.random.Generator,
) -> bytes:
    """The file a camera would write of linear light: sensor noise, encoded for display, JPEG."""
    deviation = np.sqrt(SHOT_NOISE * np.maximum(linear, 0.0) + READ_NOISE**2)
    noisy = np.clip(linear + deviation * rng.normal(size=linear.shape), 0.0, 1.0)
    display = np.where(
        noisy <= 0.0031308, 12.92 * noisy, 1.055 * np.power(noisy, 1.0 / 2.4) - 0.055
    )
    picture = PillowImage.fromarray(np.rint(255.0 * display).astype(np.uint8))
    exif = PillowImage.Exif()
    exif[ARTIST] = "Maquette"
    exif[COPYRIGHT] = "CC0 1.0"
    if equivalent_mm is not None:
        exif.get_ifd(EXIF_DIRECTORY)[FOCAL_LENGTH_IN_35MM_FILM] = equivalent_mm
    stream = io.BytesIO()
    picture.save(stream, "JPEG", quality=quality, exif=exif, optimize=True)
    return stream.getvalue()
