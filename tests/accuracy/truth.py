"""The truth of a case: the body measured as the fitter measures, light, camera and joints."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Triangles, Vertices
from fitter.body.model import regress
from fitter.fits.equipment import prepared_model
from fitter.measurement.anthropometry import AffineBody, measure
from fitter.parameters import Light
from fitter.vocabulary.choices import LightKind
from fitter.vocabulary.measurements import CENTIMETRES_PER_METRE, STATURE
from tests.accuracy.landmark_points import packaged_model
from tests.accuracy.people import Person, posed_body
from tests.accuracy.scene import DISTANT_M
from tests.accuracy.staging import Staged, lamp_place, root_joint


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
