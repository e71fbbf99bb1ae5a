"""Result documents for tests, made of the documented examples."""

import json
from typing import Any

from api_schemas.results import FitResult
from service.api.openapi import recorded_examples

_ANSWERS = recorded_examples()["answers"]
RESULT: dict[str, Any] = _ANSWERS["get_fit_result"]["200"]["sample"]


def fit_result(**changes: object) -> FitResult:
    """The example with some fields of its JSON changed."""
    return FitResult.model_validate_json(json.dumps(RESULT | changes))
