"""Another pose: what is asked for, and what comes of it; and poses by name."""

from enum import StrEnum
from typing import Annotated, Final, Literal

from pydantic import Field

from api_schemas.products.base import BodyColours, ProductOptions, ProductResult
from api_schemas.results import PartRotation


class NamedPose(StrEnum):
    """Poses by name; ``rest`` is the body model's own, with half-raised arms."""

    REST = "rest"
    STANDING = "standing"
    A_POSE = "a_pose"
    T_POSE = "t_pose"
    RELAXED = "relaxed"
    WALKING = "walking"
    SITTING = "sitting"
    ARMS_RAISED = "arms_raised"


FULL_TURN: Final = 6.2832
"""Radians, rounded up."""

Rotation = Annotated[
    tuple[Annotated[float, Field(ge=-FULL_TURN, le=FULL_TURN)], ...],
    Field(
        min_length=3,
        max_length=4,
        description=(
            "Three numbers are axis times angle in radians, four a unit quaternion x, y, z, w."
        ),
    ),
]


class PoseOptions(ProductOptions):
    """The body in another pose: a named one, or one spelled out part by part."""

    kind: Literal["pose"]
    pose: NamedPose = NamedPose.REST
    colours: BodyColours = Field(
        default=BodyColours.PICTURE,
        description=(
            "What the body wears. `plain`, too, where the picture shows nothing of the body; "
            "`albedo` needs a fit with shading."
        ),
    )
    rotations: dict[str, Rotation] = Field(
        default_factory=dict[str, Rotation],
        max_length=64,
        description=(
            "Parts that are held otherwise than in `pose`, by the names of `/v1/body-models`: "
            "their turn relative to the parent part, from the rest pose, in the body frame (x to "
            "the person's left, y up, z forward). Joints turn only as far as people's do."
        ),
        examples=[{"left_forearm": [0.0, 1.2, 0.0]}],
    )


class PoseResult(ProductResult):
    """``body_reposed.glb``, standing on the ground and facing +z, ``pose.png``, ``texture.jpg``.

    The texture is in the GLB too; the file lies beside it for OBJ.
    """

    kind: Literal["pose"] = "pose"
    pose: tuple[PartRotation, ...]
    colours: BodyColours = Field(
        default=BodyColours.PLAIN, description="What the body wears; `plain` has no texture."
    )
