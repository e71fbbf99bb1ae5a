"""How a stored result document is told: without what is asked for only now and then."""

from pydantic import BaseModel

from api_schemas.results import ResultPart


def result_json(stored: bytes, *, kind: type[BaseModel], included: frozenset[ResultPart]) -> bytes:
    """Return the document as JSON without the parts that are not ``included``.

    What earlier versions did not write is filled in, and what later ones added passed over.
    """
    result = kind.model_validate_json(stored, extra="ignore")
    left_out = {part.value: () for part in ResultPart if part not in included}
    return result.model_copy(update=left_out).model_dump_json().encode()
