"""The limb most parallel to the image plane."""

import numpy as np
import pytest

from fitter.body.pose_prior import mean_pose
from fitter.pose_init.landmark_rig import landmark_points
from fitter.pose_init.lifting import PerspectiveLifting
from fitter.pose_init.limbs import LIMB_NAMES, MIDDLES, limb_named, reference_limb
from fitter.pose_init.start_poses import start_poses
from fitter.render.camera import Camera
from tests.unit.pose_init.scenes import LENGTHS, PRIOR, RIG

CAMERA = Camera(focal_length_px=600.0, centre_x=320.0, centre_y=240.0, width=640, height=480)


def seen(pose: np.ndarray, depth: float) -> dict[str, np.ndarray]:
    points = landmark_points(RIG, pose, np.array([0.0, 0.0, depth]))
    pixels = dict(zip(RIG.landmark_names, CAMERA.project(points), strict=True))
    for name, (right, left) in MIDDLES.items():
        pixels[name] = 0.5 * (pixels[right] + pixels[left])
    return pixels


def bent(*parts: str) -> np.ndarray:
    """The mean pose with these parts flexed by 60 degrees toward the camera."""
    pose = mean_pose(PRIOR)
    for name in parts:
        part = RIG.part(name)
        pose[part] = pose[part] + np.radians(60.0) * PRIOR.axes[part, 0]
    return pose


def test_a_foreshortened_limb_is_not_chosen():
    pose = bent("left_thigh", "right_thigh")
    chosen = reference_limb(seen(pose, 3.0), LENGTHS, candidates=("left_thigh", "torso"))
    assert chosen.limb.name == "torso"


def test_its_depth_is_the_smallest_of_all_limbs_bounds():
    pixels = seen(mean_pose(PRIOR), 3.0)
    chosen = reference_limb(pixels, LENGTHS, candidates=LIMB_NAMES)
    depth = CAMERA.focal_length_px / chosen.scale
    assert depth == pytest.approx(3.0, rel=0.06)


@pytest.mark.parametrize(
    "reference", ["torso", "left_thigh", "right_thigh", "left_shin", "right_upper_arm"]
)
def test_the_root_is_found_from_any_parallel_limb(reference):
    """A limb turned parallel to the image fixes the root's depth, wherever in the body it is."""
    pose = mean_pose(PRIOR)
    points = landmark_points(RIG, pose, np.array([0.05, 0.0, 3.0]))
    points = dict(zip(RIG.landmark_names, points, strict=True))
    for name, (right, left) in MIDDLES.items():
        points[name] = 0.5 * (points[right] + points[left])
    limb = limb_named(reference)
    slant = points[limb.distal][2] - points[limb.proximal][2]
    pixels = {name: CAMERA.project(point) for name, point in points.items()}
    starts = start_poses(
        RIG,
        PRIOR,
        PerspectiveLifting(camera=CAMERA),
        pixels,
        LENGTHS,
        limb,
        limb_facing={},
        count=4,
    )
    # Taking a slanted limb for a parallel one errs by the slant, to second order.
    allowed = 0.03 + abs(slant)
    assert np.abs(starts.translation[:, 2] - 3.0).min() < allowed


def test_no_candidate_is_a_programming_error():
    with pytest.raises(ValueError, match="candidate"):
        reference_limb({}, LENGTHS, candidates=())


def test_uncertain_short_limbs_must_lead_clearly():
    pixels = seen(mean_pose(PRIOR), 3.0)
    stretched = dict(pixels)
    forearm = pixels["left_wrist"] - pixels["left_elbow"]
    stretched["left_wrist"] = pixels["left_elbow"] + 1.04 * forearm
    candidates = ("left_forearm", "left_thigh", "torso")
    chosen = reference_limb(stretched, LENGTHS, candidates=candidates)
    assert chosen.limb.name != "left_forearm"
