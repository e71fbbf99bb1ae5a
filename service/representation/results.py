"""How a stored result document is told: without what is asked for only now and then."""

from api_schemas.results import FitResult, ResultPart


def result_json(stored: bytes, *, included: frozenset[ResultPart]) -> bytes:
    """Return the document as JSON without the parts that are not ``included``."""
    result = FitResult.model_validate_json(stored)
    left_out = {part.value: () for part in ResultPart if part not in included}
    return result.model_copy(update=left_out).model_dump_json().encode()
