"""Requests that cannot be accepted: which field, what is wrong with it, what to do.

Pydantic's errors are translated to the same problems as those of our own checks.
"""

import contextlib
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import Any, Final, TypeVar, cast

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails, from_json

from api_schemas.problems import MOST_ERRORS, FieldProblem, Problem, field_problem, problem

Model = TypeVar("Model", bound=BaseModel)

Context = Mapping[str, Any]


class RefusedError(Exception):
    """Carries the problem to answer with; ``further`` fields are at fault and not named in it."""

    def __init__(self, reason: Problem, *, further: int = 0) -> None:
        super().__init__(reason.detail)
        self.problem = reason
        self.further = further


@contextlib.contextmanager
def of_view(number: int) -> Iterator[None]:
    """Let fields that are refused begin with the view they belong to."""
    try:
        yield
    except RefusedError as error:
        told = error.problem
        if not told.errors:
            raise
        named = [
            each.model_copy(update={"field": f"views.{number}.{each.field}"})
            for each in told.errors
        ]
        slug = told.type.rpartition("/")[2]
        raise refused(*named, slug=slug, further=error.further) from error


def refused(*errors: FieldProblem, slug: str = "invalid-request", further: int = 0) -> RefusedError:
    """Refuse for one or more fields; ``further`` are not among them."""
    reason = field_problem(slug, *errors, further=further)
    return RefusedError(reason, further=further + len(errors) - len(reason.errors))


def refused_field(
    *, field: str, code: str, reason: str, remedy: str, slug: str = "invalid-request"
) -> RefusedError:
    """Refuse for one field."""
    return refused(FieldProblem(field=field, code=code, reason=reason, remedy=remedy), slug=slug)


MOST_VALUES: Final = 3_000
"""The most values of a request's JSON; six pictures with 33 points each have 1,000."""

_UNIT: Final = re.compile(r"_(m|kg|px|35mm)$")
_LIKENESS: Final = 0.75
"""Least similarity of a name taken for a misspelling: `hieght` is no `light` (0.73)."""

_BOUNDS: Final[Mapping[str, str]] = {
    "greater_than": "gt",
    "greater_than_equal": "ge",
    "less_than": "lt",
    "less_than_equal": "le",
}
_BOUND_WORDS: Final[Mapping[str, str]] = {
    "gt": "greater than",
    "ge": "at least",
    "lt": "less than",
    "le": "at most",
}

_REMEDIES: Final[Mapping[str, tuple[str, Callable[[Context], str]]]] = {
    "missing": ("missing", lambda _: "Send this field."),
    "extra_forbidden": ("unknown-field", lambda _: "Remove it, or correct its name."),
    "enum": ("unknown-value", lambda context: f"Use {context['expected']}."),
    "literal_error": ("unknown-value", lambda context: f"Use {context['expected']}."),
    "float_type": ("wrong-kind", lambda _: "Send a number without quotes, such as 1.8."),
    "finite_number": ("not-finite", lambda _: "Send a finite number."),
    "too_long": ("wrong-length", lambda context: f"Send at most {context['max_length']} values."),
    "too_short": (
        "wrong-length",
        lambda context: f"Send at least {context.get('min_length', 'the required')} values.",
    ),
    "json_invalid": ("invalid-json", lambda _: "Send well-formed JSON."),
}


def parsed(kind: type[Model], text: bytes, *, whole: str, called: str) -> Model:
    """Read JSON text as a wire type.

    Parameters
    ----------
    kind
        The type.
    text
        The JSON text.
    whole
        Names what is at fault when no field of it is.
    called
        What the text is to the caller, for sentences: ``the body``.

    Raises
    ------
    RefusedError
        400 if it is not JSON, 422 if it is not of this type.
    """
    if _is_overfull(text):
        raise refused_field(
            field=whole,
            code="wrong-length",
            reason=f"The JSON has more than {MOST_VALUES} values, more than any valid request.",
            remedy="Send what /openapi.json describes for this path.",
        )
    try:
        return kind.model_validate_json(text)
    except ValidationError as error:
        found = error.errors(include_url=False, include_input=False)
        errors, further = field_problems(found, whole=whole, names=kind.model_fields)
        if errors[0].code != "invalid-json":
            raise refused(*errors, further=further) from error
        first = errors[0]
        raise RefusedError(
            problem(
                "malformed-request",
                detail=f"{called[:1].upper()}{called[1:]} is not JSON: {first.reason}",
                remedy=first.remedy,
                code=first.code,
                field=whole,
                errors=errors,
            )
        ) from error


def _is_overfull(text: bytes) -> bool:
    """Return true if it is JSON of too many values: pydantic would look at all of them."""
    if len(text) <= 2 * MOST_VALUES:
        return False
    try:
        waiting: list[Any] = [from_json(text)]
    except ValueError:
        return False
    seen = 0
    while waiting and seen <= MOST_VALUES:
        value = waiting.pop()
        seen += 1
        if isinstance(value, dict):
            waiting.extend(cast("dict[str, Any]", value).values())
        elif isinstance(value, list):
            waiting.extend(cast("list[Any]", value))
    return seen > MOST_VALUES


def field_problems(
    errors: Sequence[ErrorDetails], *, whole: str = "request", names: Collection[str] = ()
) -> tuple[tuple[FieldProblem, ...], int]:
    """Translate the first validation errors; also returns how many further ones there are.

    Parameters
    ----------
    errors
        What pydantic found.
    whole
        Names what is at fault when no field is.
    names
        The fields there are, to tell which one an unknown field was meant to be.
    """
    # Faulty items of a list do not count for its length.
    faulty = {error["loc"][:depth] for error in errors for depth in range(len(error["loc"]))}
    own = [
        error for error in errors if not (error["type"] == "too_short" and error["loc"] in faulty)
    ]
    told = tuple(_field_problem(error, whole, names) for error in own[:MOST_ERRORS])
    return told, len(own) - len(told)


def _field_problem(error: ErrorDetails, whole: str, names: Collection[str]) -> FieldProblem:
    context: Context = error.get("ctx", {})
    code, remedy = _code_and_remedy(error["type"], context)
    if code == "unknown-field" and len(error["loc"]) == 1:
        meant = _meant_field(str(error["loc"][0]), names)
        remedy = f"Remove it, or correct its name: {meant}?" if meant else remedy
    return FieldProblem(
        field=_said_field(context, error["loc"]) or _field(error["loc"]) or whole,
        code=code,
        reason=_sentence(str(context.get("reason") or error["msg"])),
        remedy=str(context.get("remedy") or remedy),
    )


def _meant_field(slip: str, names: Collection[str]) -> str | None:
    """The field whose name is most like this one; a unit at the end of either may be left out."""
    known = {_UNIT.sub("", name): name for name in names} | {name: name for name in names}
    alike = get_close_matches(slip, known, n=1, cutoff=_LIKENESS)
    return known[alike[0]] if alike else None


def _code_and_remedy(kind: str, context: Context) -> tuple[str, str]:
    if kind in _BOUNDS:
        bound = _BOUNDS[kind]
        return "out-of-range", f"Send a number {_BOUND_WORDS[bound]} {context[bound]:g}."
    if kind in _REMEDIES:
        code, remedy = _REMEDIES[kind]
        return code, remedy(context)
    if "remedy" in context:  # a refusal of our own carries its code as the kind
        return kind, ""
    return "wrong-kind", "Correct the value as the schema in /openapi.json describes it."


def _said_field(context: Context, location: Sequence[str | int]) -> str:
    """The field that a refusal names itself, which is one of the list's item it was met in."""
    if not context.get("field"):
        return ""
    items = [at for at, part in enumerate(location, start=1) if isinstance(part, int)]
    return ".".join(filter(None, (_field(location[: max(items, default=0)]), context["field"])))


def _field(location: Sequence[str | int]) -> str:
    # Parts in brackets are the alternatives of a union, or a mapping's key: not the caller's words.
    parts = [str(part) for part in location if not (isinstance(part, str) and part[:1] == "[")]
    return ".".join(part for part in parts if part not in ("body", "query", "path", "header"))


def _sentence(text: str) -> str:
    return text if text.endswith(".") else f"{text}."
