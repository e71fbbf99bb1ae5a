"""The clicks as a least-squares problem.

The energy of a pose is half the sum of squares of

- click residuals, pixels over their standard deviation,
- the pose prior and the joint limits (:mod:`fitter.body.pose_prior`),
- the trunk's slant to the image plane, a weak term: pictures of people are mostly taken level,
- a limb's slant against the facing given by the caller, if any,
- and against the detector's estimate, with Huber's loss.
"""

from collections.abc import Container, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from fitter.arrays import Points2D, Vector3
from fitter.body.model import descendants
from fitter.body.pose_prior import PosePrior
from fitter.detection.detector import DetectedSlants
from fitter.observation.clicks import click_spread_m
from fitter.pose_init.landmark_rig import LandmarkRig
from fitter.pose_init.limbs import LIMBS, MIDDLES, limb_reaches, limb_slant
from fitter.render.camera import Camera
from fitter.request import Click
from fitter.vocabulary.choices import Facing


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClickedPoints:
    """Clicks by canonical name.

    Attributes
    ----------
    names
        k landmark names.
    pixels
        (k, 2) continuous pixels.
    spread_m
        (k,) standard deviation in each direction, metres on the body.
    """

    names: tuple[str, ...]
    pixels: Points2D
    spread_m: Float[np.ndarray, " k"]

    def pixel(self, name: str) -> Float[np.ndarray, "2"] | None:
        """The click of this name, (2,), or None."""
        return self.pixels[self.names.index(name)] if name in self.names else None

    def by_name(self) -> dict[str, Float[np.ndarray, "2"]]:
        """Pixels by name."""
        return dict(zip(self.names, self.pixels, strict=True))

    def only(self, names: tuple[str, ...]) -> "ClickedPoints":
        """Those of the names that were clicked, in this order."""
        kept = [self.names.index(name) for name in names if name in self.names]
        return ClickedPoints(
            names=tuple(self.names[i] for i in kept),
            pixels=self.pixels[kept],
            spread_m=self.spread_m[kept],
        )


def clicked_points(clicks: Mapping[str, Click]) -> ClickedPoints:
    """Clicks as arrays."""
    return ClickedPoints(
        names=tuple(clicks),
        pixels=np.array([[c.x, c.y] for c in clicks.values()], dtype=np.float64).reshape(-1, 2),
        spread_m=np.array([click_spread_m(*each) for each in clicks.items()]),
    )


TRUNK_LEAN_SPREAD = 0.2
"""Standard deviation of the trunk's long axis along the view, as a sine (about 12 degrees): the
foreshortening of a lean is of second order, so a few per cent too little length would cause one."""

TRUNK_YAW_SPREAD = 1.0
"""The same for the axis across the hips: only enough to break ties toward front and back views."""

FACING_MARGIN_M = 0.02
FACING_SPREAD_M = 0.02
"""A limb said to face the camera has its far end nearer by at least this margin."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlantHints:
    """Reach of limbs along the view.

    Attributes
    ----------
    rows
        (h, k) over the rig's landmarks: far end minus near end.
    toward
        (3,) unit vector from the camera to the person, camera frame.
    reach_m, precision
        (h,) how much farther along it far ends lie, metres, and the inverse standard deviation.
    """

    rows: Float[np.ndarray, "h k"]
    toward: Vector3
    reach_m: Float[np.ndarray, " h"]
    precision: Float[np.ndarray, " h"]

    def none_of(self, landmarks: int) -> "SlantHints":
        """No hints, for a rig with this many landmarks."""
        return replace(
            self,
            rows=np.zeros((0, landmarks)),
            reach_m=np.zeros(0),
            precision=np.zeros(0),
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClickProblem:
    """The clicks and the terms that a pose is fitted to.

    Attributes
    ----------
    rig
        The person, with the landmarks used below in its own order.
    prior
        The pose prior in the rig's rest pose.
    camera
        The camera.
    clicked
        How many of the rig's landmarks were clicked; these come first: c.
    pixels
        (c, 2) the clicks, or (b, c, 2) separate ones for each pose of a batch.
    precision
        (c,) inverse standard deviation, 1/pixels.
    slants
        (s, k) rows over the rig's landmarks: far end minus near end of each limb whose facing the
        caller gave, times -1 where it faces away; the slant's depth should be negative.
    hints
        What the detector says about slants.
    turning
        (p,) joints to solve for.
    moving
        Whether to solve for the root's position.
    """

    rig: LandmarkRig
    prior: PosePrior
    camera: Camera
    clicked: int
    pixels: Float[np.ndarray, "... c 2"]
    precision: Float[np.ndarray, " c"]
    slants: Float[np.ndarray, "s k"]
    hints: SlantHints
    turning: Bool[np.ndarray, " p"]
    moving: bool


def click_problem(
    rig: LandmarkRig,
    prior: PosePrior,
    camera: Camera,
    clicks: ClickedPoints,
    *,
    scale: float,
    limb_facing: Mapping[str, Facing],
    slants: DetectedSlants | None = None,
) -> ClickProblem:
    """The problem for the whole body; ``scale`` is in pixels per metre.

    The detector's slant is ignored for limbs whose facing the caller gave.

    Joints that move no clicked landmark are left out.
    """
    ends = [name for limb in LIMBS for name in (limb.proximal, limb.distal) if name not in MIDDLES]
    corners = [name for pair in MIDDLES.values() for name in pair]
    names = tuple(dict.fromkeys((*clicks.names, *ends, *corners)))
    rig = rig.only(names)
    clicked = len(clicks.names)
    spoken_of = [
        (1.0 if limb_facing[limb.name] is Facing.TOWARD else -1.0) * limb_slant(limb, names)
        for limb in LIMBS
        if limb.name in limb_facing
    ]
    follows = rig.weights[:clicked] @ descendants(rig.part_parent).T.astype(np.float64)
    return ClickProblem(
        rig=rig,
        prior=prior,
        camera=camera,
        clicked=clicked,
        pixels=clicks.pixels,
        precision=1.0 / (scale * clicks.spread_m),
        slants=np.array(spoken_of).reshape(-1, len(names)),
        hints=_hints(rig, camera, clicks, slants, without=limb_facing),
        turning=np.asarray((follows > 1e-3).any(axis=0)),
        moving=True,
    )


def _hints(
    rig: LandmarkRig,
    camera: Camera,
    clicks: ClickedPoints,
    slants: DetectedSlants | None,
    *,
    without: Container[str],
) -> SlantHints:
    known = slants or DetectedSlants(limbs={}, middle=np.array([camera.centre_x, camera.centre_y]))
    reaches = limb_reaches(known, rig, camera, points=clicks.names, without=without)
    rows = [limb_slant(limb, rig.landmark_names) for limb in reaches.limbs]
    return SlantHints(
        rows=np.array(rows).reshape(-1, len(rig.landmark_names)),
        toward=reaches.toward,
        reach_m=reaches.reach_m,
        precision=1.0 / reaches.sigma_m,
    )
