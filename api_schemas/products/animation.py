"""A body in motion: what is asked for, and what comes of it."""

from enum import StrEnum
from typing import Annotated, Literal

from pydantic import Field

from api_schemas.products.base import BodyColours, ProductOptions, ProductResult
from api_schemas.results import FitWarning

UpAxis = Literal["x", "-x", "y", "-y", "z", "-z"]


class NamedMotion(StrEnum):
    """Motions by name; all but ``walk`` stay on one spot, and ``turn`` goes once round."""

    WALK = "walk"
    WAVE = "wave"
    TURN = "turn"
    SQUAT = "squat"
    JUMPING_JACK = "jumping_jack"


class AnimationOptions(ProductOptions):
    """The body in motion: by a BVH file that comes along, or by a name."""

    kind: Literal["animation"]
    motion: NamedMotion = Field(
        default=NamedMotion.WALK, description="What the body does; not read beside a BVH file."
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
    """``body_animated.glb``, ``body_skinned.glb``, ``animation.png`` and ``animation.webp``.

    The first holds the bodies of SCAPE as morph targets, the second bones and a skin that follows
    them linearly, which is only near to SCAPE; errors are distances of vertices from SCAPE's. Their
    texture lies beside them for OBJ too, as ``texture.jpg``.
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
    travelled_m: float = Field(description="From the first place to the last, along the ground.")
    warnings: tuple[FitWarning, ...]
