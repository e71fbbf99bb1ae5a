"""A caricature: made of the person alone."""

from typing import Final

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivation_kinds.caricature import CaricatureOptions, CaricatureResult
from service.api.derivation_kinds.definition import DerivationKindDefinition, Needs
from service.api.examples.files import files
from service.jobs.inputs import PERSON

KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.CARICATURE,
    options=CaricatureOptions,
    result=CaricatureResult,
    needs=lambda _: Needs(of_fit=(PERSON,)),
    requests={
        "caricature": {"kind": "caricature", "factor": 2.5},
        "looks": {"kind": "caricature", "factor": 2.0, "exaggerated": "looks"},
    },
    answer={
        "artifacts": files(body_caricature__glb=699740, caricature__png=238067),
        "kind": "caricature",
        "factor": 2.5,
        "coefficient": 2,
        "before": -1.711,
        "after": -4.278,
        "height_m": 1.804,
        "shape": [0.813, -1.386, -4.278],
    },
)
