"""The truth of a case: body, light and joints; and joints found beside true ones."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Triangles, Vertices
from fitter.body.model import regress
from fitter.fits.equipment import prepared_model
from fitter.measurement.anthropometry import AffineBody, measure
from fitter.parameters import Light
from fitter.training.articulation.parts import part_index
from fitter.vocabulary.choices import LightKind
from fitter.vocabulary.measurements import CENTIMETRES_PER_METRE, STATURE
from tests.accuracy.people import Person, packaged_model, posed_body
from tests.accuracy.scene import DISTANT_M
from tests.accuracy.staging import Staged, lamp_place, root_joint

MOVED_PARTS: Mapping[str, str] = {
    "shoulder": "upper_arm", "elbow": "forearm", "wrist": "hand", "hip": "thigh", "knee": "shin",
    "ankle": "foot",
}  # fmt: skip
"""The part that turns about each joint."""

Joints = Float[np.ndarray, "p 3"]
"""Camera frame, metres; NaN where the truth has none."""

WRONG_BY = 0.35
"""Difference of two slants, as a share of the limb's length, that turns a limb the wrong way if
they differ in sign: about 20 degrees, more than any unsteady click makes."""

_ENDS = (("upper_arm", "forearm"), ("forearm", "hand"), ("thigh", "shin"), ("shin", "foot"))

_ROOT = 0
_MILLIMETRES = 1000.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TrueBody:
    """A person at rest with the arms off the trunk, and what a tape finds on them.

    ``canonical`` (m, 3) with its ``triangles``, body frame, metres; ``measurements`` by name,
    centimetres and kilograms; ``stature_m`` standing.
    """

    canonical: Vertices
    triangles: Triangles
    measurements: Mapping[str, float]
    stature_m: float

    @property
    def bmi(self) -> float:
        """Weight over squared stature, kilograms per square metre."""
        return self.measurements["weight"] / self.stature_m**2


def true_body(person: Person) -> TrueBody:
    """Measure a person by the fitter's own definitions.

    Their canonical and standing pose are the body model's, taken by MakeHuman's rig.
    """
    model, measuring = packaged_model(person.gender), prepared_model(person.gender).measuring
    canonical = posed_body(person, model.canonical_pose)
    standing = posed_body(person, model.standing_pose)
    fixed = replace(
        measuring,
        canonical=_fixed(canonical),
        canonical_points=_fixed(regress(measuring.points, canonical)),
        standing_points=_fixed(regress(measuring.points, standing)),
    )
    found = measure(fixed, np.zeros(0))
    measurements = {each.name: each.value for each in found}
    return TrueBody(
        canonical=canonical,
        triangles=model.triangles,
        measurements=measurements,
        stature_m=measurements[STATURE] / CENTIMETRES_PER_METRE,
    )


def true_joints(staged: Staged) -> Float[np.ndarray, "p 3"]:
    """The body model's joints on the true posed mesh, camera frame."""
    rows = packaged_model(staged.person.gender).joint_regressor
    return regress(rows, staged.in_camera(staged.body))


def true_light(staged: Staged) -> Light:
    """The lamp in the fitter's terms: spherical coordinates about the root joint."""
    lamp = staged.case.lighting.lamp
    toward = staged.to_camera @ (lamp_place(staged, lamp) - root_joint(staged))
    distant = lamp.distance_m >= DISTANT_M
    return light_toward(toward, LightKind.DIRECTIONAL if distant else LightKind.POINT)


def light_toward(toward: Float[np.ndarray, "3"], kind: LightKind) -> Light:
    """The light that lies so far from the root joint, camera frame, metres."""
    distance = float(np.linalg.norm(toward))
    x, y, z = toward / distance
    return Light(
        kind=kind,
        azimuth=float(np.arctan2(x, -z)),
        elevation=float(np.arcsin(-y)),
        distance=distance,
    )


def _fixed(points: Vertices) -> AffineBody:
    """A body that no coefficient changes."""
    return AffineBody(mean=points, derivative=np.zeros((0, *points.shape)))


def part_of_joint(joint: str) -> int:
    """The part that turns about a joint of a side, ``left_knee``."""
    side, name = joint.split("_")
    return part_index(f"{side}_{MOVED_PARTS[name]}")


def joint_error_mm(found: Joints, true: Joints) -> float:
    """Mean distance of the joints that the truth has.

    Both root joints are put together; where the truth has none, both hips' middles.
    """
    middle = _hips_middle if np.isnan(true[_ROOT]).any() else _root
    difference = (found - middle(found)) - (true - middle(true))
    return _MILLIMETRES * float(np.nanmean(np.linalg.norm(difference, axis=1)))


def _root(joints: Joints) -> Float[np.ndarray, "3"]:
    return joints[_ROOT]


def _hips_middle(joints: Joints) -> Float[np.ndarray, "3"]:
    return joints[[part_of_joint("left_hip"), part_of_joint("right_hip")]].mean(axis=0)


def wrong_limbs(found: Joints, true: Joints) -> tuple[str, ...]:
    """Names of the limbs that slant the wrong way; joints in the camera frame."""
    return tuple(
        f"{side}_{near}"
        for side in ("left", "right")
        for near, far in _ENDS
        if _wrong(_slant(found, side, near, far), _slant(true, side, near, far))
    )


def _wrong(found: float, true: float) -> bool:
    return found * true < 0.0 and abs(found - true) > WRONG_BY


def _slant(joints: Joints, side: str, near: str, far: str) -> float:
    limb = joints[part_index(f"{side}_{far}")] - joints[part_index(f"{side}_{near}")]
    return float(limb[2] / np.linalg.norm(limb))
