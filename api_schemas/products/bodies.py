"""Products that are bodies: with a texture, in another pose, in motion, as a caricature."""

from enum import StrEnum
from typing import Annotated, Final, Literal

from pydantic import AfterValidator, Field, WithJsonSchema

from api_schemas.base import WholeNumber, refusal
from api_schemas.products.base import BodyColours, ProductOptions, ProductResult
from api_schemas.results import Vector
from fitter.vocabulary.choices import BoneNames
from fitter.vocabulary.remarks import Remark

TEXTURE_SIZES: Final = (512, 1_024, 2_048)
"""Sides a texture may have, texels."""


def _texture_size(size: int) -> int:
    if size in TEXTURE_SIZES:
        return size
    raise refusal(
        code="unknown-value",
        reason=f"A texture of {size} texels cannot be made.",
        remedy=f"Use {', '.join(map(str, TEXTURE_SIZES[:-1]))} or {TEXTURE_SIZES[-1]}.",
    )


TextureColours = Literal[BodyColours.PICTURE, BodyColours.ALBEDO]
"""The picture as it is, with its light, or the albedo found in it, to be lit anew."""


class TextureOptions(ProductOptions):
    """The picture laid on the body, or the albedo found in it, which needs a fit with shading."""

    kind: Literal["texture"]
    colours: TextureColours = BodyColours.PICTURE
    size: Annotated[
        WholeNumber,
        AfterValidator(_texture_size),
        WithJsonSchema({"type": "integer", "enum": list(TEXTURE_SIZES)}),
    ] = Field(default=1_024, description="Side of the texture, texels.")


class TextureResult(ProductResult):
    """``body_textured.glb``, in the fitted pose, ``texture.png`` and ``coverage.png``.

    White texels of the coverage were seen in the picture, grey ones are taken from the other side
    of the body, black ones continued from their surroundings: these two kinds are invented. An
    albedo may exceed 1: it is the texture's linear value times ``scale``.
    """

    kind: Literal["texture"] = "texture"
    colours: TextureColours
    size: int
    seen_share: float = Field(ge=0.0, le=1.0, description="Of the body's texels.")
    mirrored_share: float = Field(ge=0.0, le=1.0, description="Of the body's texels.")
    scale: float


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
    pose: dict[str, Vector] = Field(description="As in the fit's result.")
    colours: BodyColours = Field(
        default=BodyColours.PLAIN, description="What the body wears; `plain` has no texture."
    )


UpAxis = Literal["y", "-y", "z", "-z", "x", "-x"]


class NamedMotion(StrEnum):
    """The walk, and two poses in which a body for other programs stands still."""

    WALK = "walk"
    A_POSE = "a_pose"
    T_POSE = "t_pose"


class AnimationOptions(ProductOptions):
    """The body in motion: by a BVH file that comes along, or by a name."""

    kind: Literal["animation"]
    motion: NamedMotion = Field(
        default=NamedMotion.A_POSE,
        description=(
            "What the body does; not read beside a BVH file. `a_pose` and `t_pose` give a rig: one "
            "GLB with bones and skin in that pose, to be moved by another program."
        ),
    )
    bones: BoneNames = Field(
        default=BoneNames.MAQUETTE,
        description=(
            "Whose names the bones have, in `body_skinned.glb` and `motion.bvh`. In the T-pose no "
            "bone is turned, its axes are the body frame's."
        ),
    )
    in_place: bool = Field(
        default=True,
        description="Whether the body stays on its spot; else it goes its way along the ground.",
    )
    colours: BodyColours = Field(
        default=BodyColours.PICTURE,
        description=(
            "What the body wears. `plain`, too, where the picture shows nothing of the body; "
            "`albedo` needs a fit with shading."
        ),
    )
    start_s: float = Field(
        default=0.0,
        ge=0.0,
        le=3_600.0,
        description="Where the stretch begins, of the file or of a named motion without end.",
    )
    duration_s: float | None = Field(
        default=None,
        gt=0.0,
        le=3_600.0,
        description=(
            "How long the stretch is; null goes on to the file's end, or is a few repetitions of "
            "a named motion. An animation has 30 frames a second and 360 in all at most: what is "
            "longer is cut, with a warning."
        ),
    )
    joints: dict[str, Annotated[str, Field(max_length=200)]] = Field(
        default_factory=dict[str, str],
        max_length=64,
        description=(
            "Which joint of the BVH file moves which part of the body: names of the file's joints, "
            "by the names that `/v1/body-models` gives to parts. Parts not named here are found by "
            "the names that programs give to joints."
        ),
        examples=[{"left_thigh": "Oberschenkel_L", "right_thigh": "Oberschenkel_R"}],
    )
    up: UpAxis | None = Field(
        default=None,
        description=(
            "Which axis of the BVH file points up; null finds it from the motion, along which "
            "heads are above feet. Send it for a person who lies."
        ),
    )

    @property
    def part(self) -> str:
        """A motion may come along."""
        return "bvh"

    @property
    def part_is_for(self) -> str | None:
        """Some options speak of it."""
        return "`joints` and `up` are about" if self.joints or self.up else None


class AnimationResult(ProductResult):
    """``body_animated.glb``, ``body_skinned.glb``, ``motion.bvh`` and a film, ``animation.webp``.

    The first holds the bodies of SCAPE as morph targets, the second bones and a skin that follows
    them linearly, which is only near to SCAPE; errors are distances of vertices from SCAPE's. The
    third has the motion of the bones in centimetres. Textures lie beside for OBJ too, as
    ``texture.jpg``. Of a rig there is the second alone; its errors are those over the poses
    that have names.
    """

    kind: Literal["animation"] = "animation"
    colours: BodyColours = Field(
        default=BodyColours.PLAIN, description="What the body wears; `plain` has no texture."
    )
    motion: NamedMotion | None = Field(
        default=None, description="The motion by its name; null of a BVH file."
    )
    source: str = Field(description="Where the motion comes from.")
    up: UpAxis | None = Field(
        default=None,
        description="Which axis of the BVH file was taken to point up; null for a named motion.",
    )
    frames: int
    frame_time_s: float
    morph_targets: int
    morph_mean_error_mm: float
    morph_largest_error_mm: float
    skin_mean_error_mm: float
    skin_largest_error_mm: float
    sliding_mm: float = Field(
        description="How far soles on the ground slide from frame to frame, on average."
    )
    travelled_m: float = Field(
        description="From the first place to the last along the ground, in place or not."
    )
    warnings: tuple[Remark, ...]


class Exaggerated(StrEnum):
    """Shape coefficients that a caricature multiplies."""

    COEFFICIENT = "coefficient"
    LOOKS = "looks"


class CaricatureOptions(ProductOptions):
    """The body with what is unusual of it exaggerated, as tall as it is."""

    kind: Literal["caricature"]
    factor: float = Field(
        default=2.0,
        ge=0.0,
        le=100.0,
        description=(
            "By which it is multiplied; 1 is the body as it was fitted. Where the surface would "
            "turn inside out or run through itself, the job fails and names the largest factor "
            "that can be used."
        ),
    )
    exaggerated: Exaggerated = Field(
        default=Exaggerated.COEFFICIENT,
        description=(
            "`coefficient`: the shape coefficient that deviates most from the mean, as in the "
            "paper; often little is seen of it. `looks`: all coefficients but the height's, so "
            "how the body differs from the average one of its height."
        ),
    )


class CaricatureResult(ProductResult):
    """``body_caricature.glb``, in the fitted pose, and ``caricature.png``, beside the fitted body.

    ``coefficient`` is the index, in ``shape`` of the fit's result, of what deviates most; with
    ``looks`` the others are multiplied by the same factor.
    """

    kind: Literal["caricature"] = "caricature"
    factor: float
    coefficient: int = Field(ge=1)
    before: float = Field(description="Of the fitted body, in standard deviations.")
    after: float = Field(description="Of the caricature.")
    height_m: float = Field(description="Of both.")
    shape: tuple[float, ...] = Field(description="All of the caricature's coefficients.")
