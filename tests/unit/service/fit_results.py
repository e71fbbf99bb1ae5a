"""A result document for tests, made of the documented example."""

import json

from api_schemas.results import FitResult
from service.api.examples.results import RESULT


def fit_result(**changes: object) -> FitResult:
    """The example with some fields of its JSON changed."""
    return FitResult.model_validate_json(json.dumps(RESULT | changes))


def measurement(name: str, **changes: object) -> dict[str, object]:
    """A measurement of the result's JSON."""
    example: dict[str, object] = RESULT["measurements"][-1]
    return example | {"name": name} | changes
