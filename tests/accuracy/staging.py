"""A person in place: posed, on the floor, seen by the camera. World and camera frames.

World: metres, y up, the person at the origin on the floor y = 0, the camera at positive z.
"""

from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import Pose, Vertices
from fitter.observation.pixels import display_from_linear
from fitter.render.camera import Camera, focal_length_px_from_35mm
from fitter.render.rasterizer import Rendering, render
from tests.accuracy.meshes import faces_of_group
from tests.accuracy.people import (
    Person,
    load_person,
    posed_body,
    posed_bones,
    posed_skin,
    posed_with_bone,
    rig_of_people,
)
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.scene import Case, Lamp, View
from tests.accuracy.stances import lowest, standing_on_both_feet

TO_LIGHT = np.array([-0.5, -0.6, -0.6]) / np.linalg.norm([-0.5, -0.6, -0.6])
AMBIENT, DIFFUSE = 0.2, 0.7
SKIN, CLOTH, WALL = (0.5, 0.3, 0.22), (0.1, 0.12, 0.3), 0.25
CLOTHED = (0.44, 0.54)
"""Between these shares of the height above the floor people wear shorts."""

_SOFTNESS_PX, _NOISE = 0.6, 0.003

FOOT_HEIGHT_AT_REST_M = 0.1
"""Vertices this low at rest form the feet."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Staged:
    """A case's person in place.

    Attributes
    ----------
    pose
        (p, 3) of the 17 parts, body frame.
    shift
        (3,) from the posed body frame to the world, metres.
    body
        (m, 3) world, the body's vertices.
    joints
        By name of the rig's bone, the posed bone's head, world.
    camera
        Intrinsics.
    to_camera
        (3, 3) rotation from world to camera axes.
    eye
        (3,) the camera's place, world.
    """

    person: Person
    case: Case
    pose: Pose
    shift: Float[np.ndarray, "3"]
    body: Vertices
    bones: dict[str, Float[np.ndarray, "3"]]
    camera: Camera
    to_camera: Float[np.ndarray, "3 3"]
    eye: Float[np.ndarray, "3"]

    def in_camera(self, points: Float[np.ndarray, "... 3"]) -> Float[np.ndarray, "... 3"]:
        """World points in the camera frame (OpenCV axes)."""
        return (points - self.eye) @ self.to_camera.T

    def source_vertices(self, vertex_ids: np.ndarray) -> Vertices:
        """Chosen source vertices with the fingers curled, world."""
        stance = self.case.stance
        curl = {"left": stance.left_arm.curl, "right": stance.right_arm.curl}
        return posed_skin(self.person, self.pose, curl=curl, vertex_ids=vertex_ids) + self.shift

    def on_bone(self, bone: str, rest: Vertices) -> Vertices:
        """Points of the body frame at rest that follow one bone, world."""
        return posed_with_bone(self.person, self.pose, bone=bone, points=rest) + self.shift


def stage(person: Person, case: Case) -> Staged:
    """Pose a person and put them before the camera."""
    surface = rig_of_people().surface
    rest = surface.body(person.source_vertices)
    low = rest[:, 1] < rest[:, 1].min() + FOOT_HEIGHT_AT_REST_M
    feet = {"left": low & (rest[:, 0] > 0.0), "right": low & (rest[:, 0] < 0.0)}

    def foot_height(pose: Pose, side: str) -> float:
        return lowest(posed_body(person, pose), feet[side])

    pose = standing_on_both_feet(case.stance, person.joints, foot_height)
    body = posed_body(person, pose)
    bones = posed_bones(person, pose)
    support = body[feet["left"] | feet["right"]].mean(axis=0)
    sole_m = 0.0 if case.outfit is None else case.outfit.sole_m
    shift = np.array([-support[0], sole_m - body[:, 1].min(), -support[2]])
    to_camera, eye = _look(case.view)
    return Staged(
        person=person,
        case=case,
        pose=pose,
        shift=shift,
        body=body + shift,
        bones={name: head + shift for name, head in bones.items()},
        camera=camera_of(case.view),
        to_camera=to_camera,
        eye=eye,
    )


def camera_of(view: View) -> Camera:
    """Intrinsics of a view; the principal point is the picture's middle."""
    return Camera(
        focal_length_px=focal_length_px_from_35mm(
            view.equivalent_mm, width=view.width, height=view.height
        ),
        centre_x=view.width / 2.0,
        centre_y=view.height / 2.0,
        width=view.width,
        height=view.height,
    )


def root_joint(staged: Staged) -> Float[np.ndarray, "3"]:
    """The pelvis' centre, world: what a fit's translation and light refer to."""
    return 0.5 * (staged.bones["upperleg01.L"] + staged.bones["upperleg01.R"])


def lamp_place(staged: Staged, lamp: Lamp) -> Float[np.ndarray, "3"]:
    """Where a lamp is, world: its angles are about the root joint, in the camera's axes."""
    azimuth, elevation = np.radians(lamp.azimuth), np.radians(lamp.elevation)
    toward = np.array(
        [
            np.cos(elevation) * np.sin(azimuth),
            -np.sin(elevation),
            -np.cos(elevation) * np.cos(azimuth),
        ]
    )
    return root_joint(staged) + lamp.distance_m * (staged.to_camera.T @ toward)


def body_group_ids() -> np.ndarray:
    """Source vertices of the whole body surface, cavities included."""
    return np.unique(faces_of_group("body").quads)


def _look(view: View) -> tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, "3"]]:
    eye = np.array([0.0, view.height_m, view.distance_m])
    target = np.array([view.aim_aside_m, view.aim_height_m, 0.0])
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, np.array([0.0, 1.0, 0.0]))
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(forward, right), forward]), eye


def rendering(staged: Staged) -> Rendering:
    """The true body, without hair and clothes, in the case's camera."""
    return render(staged.in_camera(staged.body), rig_of_people().surface.triangles, staged.camera)


def plain_picture(case: Case, *, turned_deg: float) -> UInt8[np.ndarray, "h w 3"]:
    """A case's person by our own rasteriser, without hair and clothes but colour; sRGB.

    They are turned about the upright axis from how they stand there.
    """
    stance = replace(case.stance, facing=case.stance.facing + turned_deg)
    staged = stage(load_person(PEOPLE[case.person]), replace(case, stance=stance))
    faces, triangles = rendering(staged).face_ids, rig_of_people().surface.triangles
    corners = staged.in_camera(staged.body)[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    heights = staged.body[triangles].mean(axis=1)[:, 1] - staged.body[:, 1].min()
    shares = heights / np.ptp(staged.body[:, 1])
    clothed = (shares > CLOTHED[0]) & (shares < CLOTHED[1])
    light = AMBIENT + DIFFUSE * np.clip(normals @ TO_LIGHT, 0.0, 1.0)
    colours = np.where(clothed[:, None], CLOTH, SKIN) * light[:, None]
    shown = np.where((faces >= 0)[..., None], colours[faces], WALL)
    noise = np.random.default_rng(case.seed).normal(0.0, _NOISE, shown.shape)
    soft = cv2.GaussianBlur(shown, (0, 0), _SOFTNESS_PX) + noise
    return np.rint(255.0 * display_from_linear(np.clip(soft, 0.0, 1.0))).astype(np.uint8)
