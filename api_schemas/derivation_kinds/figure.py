"""A figure as in the paper: what is asked for, and what comes of it."""

from typing import Literal

from pydantic import Field

from api_schemas.derivation_kinds.base import DerivationOptions, DerivedFiles
from api_schemas.derivation_kinds.pose import NamedPose


class FigureOptions(DerivationOptions):
    """Picture, overlay, recovered body and a new pose side by side, as in the paper's Fig. 10."""

    kind: Literal["figure"]
    pose: NamedPose = NamedPose.STANDING
    degrees: float = Field(
        default=0.0,
        ge=-360.0,
        le=360.0,
        description="How far the onlooker of the two bodies has walked to the right round them.",
    )


class FigureResult(DerivedFiles):
    """``figure.png``, and the body in its new pose, ``body_reposed.glb``."""

    kind: Literal["figure"] = "figure"
    pose: NamedPose
