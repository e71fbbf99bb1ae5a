"""A person in place: posed, on the floor, seen by the camera. World and camera frames.

World: metres, y up, the person at the origin on the floor y = 0, the camera at positive z.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose, Vertices
from fitter.render.camera import Camera, focal_length_px_from_35mm
from tests.accuracy.makehuman_faces import faces_of_group
from tests.accuracy.people import (
    Person,
    posed_body,
    posed_bones,
    posed_skin,
    posed_with_bone,
    rig_of_people,
)
from tests.accuracy.scene import Case, Lamp, View
from tests.accuracy.stances import lowest, standing_on_both_feet

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
