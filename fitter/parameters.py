"""The unknowns of the fit: body, light and reflectance (Θ_B, Θ_L, Θ_R in the paper)."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex, Pose, Shape, Vector3

Surroundings = Float[np.ndarray, "9"]
"""Light from all around: the coefficients e of :mod:`fitter.render.surroundings`."""


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


class LightKind(StrEnum):
    """Section 5: a point light (indoors) or a distant directional one (outdoors)."""

    POINT = "point"
    DIRECTIONAL = "directional"


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
    surroundings
        The light from all around relative to l = 1, camera frame; None where it is the constant
        ambient b of Eq. 1.
    """

    kind: LightKind
    azimuth: float
    elevation: float
    distance: float
    surroundings: Surroundings | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Reflectance:
    """Θ_R = [a, s, b, α] of Eq. 1, in linear light, on luminance.

    Attributes
    ----------
    albedo, specularity
        (m,) per vertex, >= 0.
    ambient
        b, >= 0; 0 where the light has surroundings.
    specular_exponent
        α, >= 1.
    """

    albedo: PerVertex
    specularity: PerVertex
    ambient: float
    specular_exponent: float
