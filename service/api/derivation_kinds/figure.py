"""The figure: made of the person, the picture and the overlay."""

from typing import Final

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivation_kinds.figure import FigureOptions, FigureResult
from service.api.derivation_kinds.definition import DerivationKindDefinition, Needs
from service.api.examples.files import files
from service.jobs.inputs import IMAGE, OVERLAY, PERSON

KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.FIGURE,
    options=FigureOptions,
    result=FigureResult,
    needs=lambda _: Needs(of_fit=(PERSON, IMAGE, OVERLAY)),
    requests={"figure": {"kind": "figure", "pose": "arms_raised", "degrees": 30}},
    answer={
        "artifacts": files(figure__png=912000),
        "kind": "figure",
        "pose": "arms_raised",
    },
)
