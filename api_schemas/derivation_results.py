"""What came of a derivation: ``result.json``, by its kind."""

from typing import Annotated, Literal
from uuid import UUID

from pydantic import ConfigDict, Field, RootModel, Tag

from api_schemas.base import WireModel
from api_schemas.derivations import BY_KIND, NamedPose, TextureColours
from api_schemas.results import (
    Artifact,
    BodyResult,
    CameraResult,
    FitWarning,
    LightResult,
    Measurement,
    Outcome,
    PartRotation,
    ReflectanceResult,
)


class DerivedFiles(WireModel):
    """What all results of derivations have in common."""

    # What is always answered is said to be: ``kind`` tells one from another.
    model_config = ConfigDict(json_schema_serialization_defaults_required=True)

    artifacts: tuple[Artifact, ...]


class ReportResult(DerivedFiles):
    """``report.html`` and ``report.pdf``, the same page; both stand alone."""

    kind: Literal["report"] = "report"


class CaricatureResult(DerivedFiles):
    """``body_caricature.glb``, in the fitted pose, and ``caricature.png``, beside the fitted body.

    ``coefficient`` is the index, in ``shape`` of the fit's result, of what was multiplied.
    """

    kind: Literal["caricature"] = "caricature"
    factor: float
    coefficient: int = Field(ge=1)
    before: float = Field(description="Of the fitted body, in standard deviations.")
    after: float = Field(description="Of the caricature.")
    height_m: float = Field(description="Of both.")
    shape: tuple[float, ...] = Field(description="All of the caricature's coefficients.")


class PoseResult(DerivedFiles):
    """``body_reposed.glb``, standing on the ground and facing +z, and ``pose.png``."""

    kind: Literal["pose"] = "pose"
    pose: tuple[PartRotation, ...]


class AnimationResult(DerivedFiles):
    """``body_animated.glb``, ``body_skinned.glb``, ``animation.png`` and ``animation.webp``.

    The first holds the bodies of SCAPE as morph targets, the second bones and a skin that follows
    them linearly, which is only near to SCAPE; errors are distances of vertices from SCAPE's.
    """

    kind: Literal["animation"] = "animation"
    source: str = Field(description="Where the motion comes from.")
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


class TextureResult(DerivedFiles):
    """``body_textured.glb``, in the fitted pose, ``texture.png``, ``coverage.png``, ``atlas.png``.

    White texels of the coverage were seen in the picture, grey ones are taken from the other side
    of the body, black ones continued from their surroundings: these two kinds are invented. A
    texture of one's own has no coverage, and shares of nothing. An albedo may exceed 1: it is the
    texture's linear value times ``scale``.

    The atlas is a transparent drawing of the body's parts where the texture has them, with their
    names: a layer to paint under. Only what lies on the parts counts of what is painted; it is
    drawn on beyond their edges.
    """

    kind: Literal["texture"] = "texture"
    colours: TextureColours
    size: int
    seen_share: float = Field(ge=0.0, le=1.0, description="Of the body's texels.")
    mirrored_share: float = Field(ge=0.0, le=1.0, description="Of the body's texels.")
    scale: float


class FigureResult(DerivedFiles):
    """``figure.png``."""

    kind: Literal["figure"] = "figure"
    pose: NamedPose


class CombinedPicture(WireModel):
    """The person in one of the pictures, with the shape that all have in common.

    ``outcome``, ``light`` and the others are as in the result of a fit. The picture's files are
    ``body_posed_N.glb`` and ``overlay_N.png`` with ``number`` for N.
    """

    number: int = Field(ge=1, description="1 is this fit, the others follow as they were named.")
    fit_id: UUID
    outcome: Outcome
    image_camera: CameraResult
    body: BodyResult
    light: LightResult | None
    reflectance: ReflectanceResult | None
    silhouette_overlap: float = Field(description="Intersection over union of body and silhouette.")


class CombinedResult(DerivedFiles):
    """``body_combined.glb``, in the canonical pose, and ``combined.png``, beside this fit alone.

    ``bodies`` are those of the pictures, each in its own pose and light.
    """

    kind: Literal["combined"] = "combined"
    pictures: int
    shape: tuple[float, ...]
    bodies: tuple[CombinedPicture, ...]
    measurements: tuple[Measurement, ...]
    agreement: float = Field(
        ge=0.0,
        le=1.0,
        description=(
            "How often pictures of one person give bodies that differ as much as these do; below "
            "0.01 a warning names the fit that differs most."
        ),
    )
    warnings: tuple[FitWarning, ...]


AnyDerivationResult = (
    Annotated[ReportResult, Tag("[report]")]
    | Annotated[CaricatureResult, Tag("[caricature]")]
    | Annotated[PoseResult, Tag("[pose]")]
    | Annotated[AnimationResult, Tag("[animation]")]
    | Annotated[TextureResult, Tag("[texture]")]
    | Annotated[FigureResult, Tag("[figure]")]
    | Annotated[CombinedResult, Tag("[combined]")]
)


class DerivationResult(RootModel[Annotated[AnyDerivationResult, BY_KIND]]):
    """``result.json`` of a derivation; ``kind`` says which fields there are."""

    model_config = ConfigDict(frozen=True, strict=True)
