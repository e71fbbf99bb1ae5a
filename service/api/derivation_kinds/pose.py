"""Another pose: made of the person alone."""

from typing import Final

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivation_kinds.pose import PoseOptions, PoseResult
from service.api.derivation_kinds.definition import DerivationKindDefinition, Needs
from service.api.examples.files import files
from service.jobs.inputs import PERSON

KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.POSE,
    options=PoseOptions,
    result=PoseResult,
    needs=lambda _: Needs(of_fit=(PERSON,)),
    requests={
        "pose": {
            "kind": "pose",
            "pose": "standing",
            "rotations": {"head": [0.0, 0.35, 0.0], "left_forearm": [0.0, 0.0, 0.0, 1.0]},
        }
    },
    answer={
        "artifacts": files(body_reposed__glb=699656, pose__png=160197),
        "kind": "pose",
        "pose": [
            {"part": "pelvis", "rotation": [0.0, 0.0, 0.0]},
            {"part": "spine", "rotation": [0.105, 0.0, 0.0]},
        ],
    },
)
