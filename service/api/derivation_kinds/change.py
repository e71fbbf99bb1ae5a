"""A comparison of two fits: made of both persons' measurements."""

from typing import Final

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivation_kinds.change import ChangeOptions, ChangeResult
from service.api.derivation_kinds.combined import OTHER_FIT_ID
from service.api.derivation_kinds.definition import DerivationKindDefinition, Needs
from service.api.examples.files import files
from service.jobs.inputs import PERSON, RESULT

_MEASURED: Final = (PERSON, RESULT)

KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.CHANGE,
    options=ChangeOptions,
    result=ChangeResult,
    needs=lambda options: Needs(
        of_fit=_MEASURED, other_fits={"since": options.since}, of_others=_MEASURED
    ),
    requests={
        "change": {
            "kind": "change",
            "since": OTHER_FIT_ID,
            "measurements": ["waist_girth_navel", "weight"],
        }
    },
    answer={
        "artifacts": files(changes__csv=243),
        "kind": "change",
        "since": OTHER_FIT_ID,
        "significance": 0.05,
        "changes": [
            {
                "name": "waist_girth_navel",
                "unit": "cm",
                "before": 91.2,
                "after": 84.3,
                "difference": -6.9,
                "standard_error": 2.4,
                "shared_error": 0.4,
                "p_value": 0.004,
                "least": 4.7,
                "is_change": True,
            },
            {
                "name": "weight",
                "unit": "kg",
                "before": 81.0,
                "after": 77.5,
                "difference": -3.5,
                "standard_error": 0.0,
                "shared_error": 0.0,
                "p_value": None,
                "least": 0.0,
                "is_change": True,
            },
        ],
        "warnings": [],
    },
)
