"""The unknowns of a fit: body, light, reflectance (Θ_B, Θ_L, Θ_R in the paper), camera tilt."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex, Pose, Shape, Vector3
from fitter.vocabulary.choices import LightKind
from fitter.vocabulary.outcomes import StanceKind


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyParameters:
    """Θ_B = [β, θ] with the position of the body.

    Attributes
    ----------
    pose
        (p, 3) axis-angle per part, radians, relative to the parent part, in the axes of the rest
        body (body frame). ``pose[0]`` turns the whole body; zero faces the camera upright, because
        the camera frame is the body frame times diag(1, -1, -1).
    translation
        Position of the root joint (pelvis) in the camera frame, metres.
    shape
        (n,) coefficients of the height-preserving basis, in standard deviations; ``shape[0]`` is
        the height axis.
    """

    pose: Pose
    translation: Vector3
    shape: Shape


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CameraTilt:
    """Tilt of the camera against gravity, and the stance of the person under it.

    In the camera frame (OpenCV axes) up is
    (-sin roll cos pitch, -cos roll cos pitch, sin pitch).

    Attributes
    ----------
    pitch
        Radians; positive for a camera that looks up, negative for one that looks down.
    roll
        Radians; positive for a camera turned clockwise, seen from behind it.
    covariance
        (2, 2) of pitch and roll, squared radians.
    stances
        The probability of each kind.
    """

    pitch: float
    roll: float
    covariance: Float[np.ndarray, "2 2"]
    stances: Mapping[StanceKind, float]

    @property
    def stance(self) -> StanceKind:
        """The most probable kind."""
        return max(self.stances, key=lambda kind: self.stances[kind])

    @property
    def standard_errors(self) -> tuple[float, float]:
        """Standard errors of pitch and roll, radians."""
        pitch, roll = np.sqrt(self.covariance.diagonal())
        return float(pitch), float(roll)

    @property
    def up(self) -> Vector3:
        """(3,) unit vector against gravity, camera frame."""
        level = np.cos(self.pitch)
        return np.array(
            [-np.sin(self.roll) * level, -np.cos(self.roll) * level, np.sin(self.pitch)]
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Light:
    """Θ_L = [γ, φ, z]: spherical coordinates about the body's centre, in the camera's axes.

    The direction from the body's centre toward the light, in the camera frame, is
    (cos φ sin γ, -sin φ, -cos φ cos γ): ``azimuth`` 0 and ``elevation`` 0 is a light at the
    camera's side of the body, positive azimuth comes from the right of the picture, positive
    elevation from above. Light intensity l is 1 at the body's centre by convention, because
    Eq. 1 only knows the product of intensity with albedo and specularity.

    Attributes
    ----------
    kind
        Point (quadratic attenuation) or directional (constant).
    azimuth, elevation
        Radians.
    distance
        Metres from the body's centre; meaningless and infinite for a directional light.
    """

    kind: LightKind
    azimuth: float
    elevation: float
    distance: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Reflectance:
    """Θ_R = [a, s, b, α] of Eq. 1, in linear light, on luminance.

    Attributes
    ----------
    albedo, specularity
        (m,) per vertex, >= 0.
    ambient
        b, >= 0.
    specular_exponent
        α, >= 1.
    """

    albedo: PerVertex
    specularity: PerVertex
    ambient: float
    specular_exponent: float
