"""Body-fat share: made of the person's measurements."""

from typing import Final

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivation_kinds.body_composition import (
    BodyCompositionOptions,
    BodyCompositionResult,
)
from service.api.derivation_kinds.definition import DerivationKindDefinition, Needs
from service.api.examples.files import files
from service.jobs.inputs import PERSON, RESULT

KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.BODY_COMPOSITION,
    options=BodyCompositionOptions,
    result=BodyCompositionResult,
    needs=lambda _: Needs(of_fit=(PERSON, RESULT)),
    requests={"body-composition": {"kind": "body_composition", "age_years": 34}},
    answer={
        "artifacts": files(body_composition__csv=742),
        "kind": "body_composition",
        "age_years": 34.0,
        "bmi": 24.1,
        "bmi_standard_error": 0.9,
        "estimates": [
            {
                "name": "us_navy",
                "source": "Hodgdon and Beckett 1984, Prediction of percent body fat for U.S. Navy "
                "men and women, Naval Health Research Center, report 84-11",
                "population": "Serving sailors of the US Navy, weighed under water.",
                "differences": "The neck is the smallest girth between its base and the jaw.",
                "percent": 17.7,
                "standard_error": 4.0,
                "regression_error": 3.52,
                "measurement_error": 1.9,
                "low": 9.9,
                "high": 25.5,
                "inputs": ["waist_girth_navel", "neck_girth", "stature"],
                "withheld": [],
            },
        ],
    },
)
