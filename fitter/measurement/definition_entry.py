"""One JSON object of a definitions file, read field by field with errors that name it."""

from collections.abc import Mapping
from enum import StrEnum
from typing import NoReturn, TypeVar, cast

from fitter.errors import DefinitionError

T = TypeVar("T")
C = TypeVar("C", bound=StrEnum)


class DefinitionEntry:
    """A JSON object, by what errors call it."""

    def __init__(self, name: str, fields: object) -> None:
        if not isinstance(fields, dict):
            message = f"{name}: expected an object, found {type(fields).__name__}."
            raise DefinitionError(message)
        self.name = name
        self.fields = cast("Mapping[str, object]", fields)

    def value(self, field: str, kind: type[T]) -> T:
        """The field's value, of a type; whole numbers will do for others."""
        if field not in self.fields:
            self.fail(field, "is missing")
        found = self.fields[field]
        if kind is float and isinstance(found, int) and not isinstance(found, bool):
            found = float(found)
        if not isinstance(found, kind) or (isinstance(found, bool) and kind is not bool):
            self.fail(field, f"is {found!r}, not of type {kind.__name__}")
        return cast("T", found)

    def names(self, field: str, *, may_be_empty: bool = False) -> tuple[str, ...]:
        """A list of names."""
        values = self.value(field, list)
        if not (values or may_be_empty) or not all(isinstance(value, str) for value in values):
            self.fail(field, f"is {values!r}, not a list of names")
        return tuple(cast("list[str]", values))

    def choice(self, field: str, kind: type[C]) -> C:
        """One of a few words."""
        text = self.value(field, str)
        if text not in list(kind):
            self.fail(field, f"is {text!r}, not one of {', '.join(kind)}")
        return kind(text)

    def path(self, field: str) -> tuple[tuple[str, ...], ...]:
        """Lists of names, at least two."""
        steps = tuple(
            DefinitionEntry(self.name, {field: step}).names(field)
            for step in self.value(field, list)
        )
        if len(steps) < 2:
            self.fail(field, "has fewer than two points")
        return steps

    def directions(self, field: str) -> tuple[tuple[float, float, float] | None, ...]:
        """Triples of numbers; None where there is null."""
        found: list[tuple[float, float, float] | None] = []
        for value in self.value(field, list):
            if value is None:
                found.append(None)
                continue
            if not isinstance(value, list) or len(value) != 3:
                self.fail(field, f"has {value!r}, not three numbers or null")
            x, y, z = (
                DefinitionEntry(self.name, {field: each}).value(field, float) for each in value
            )
            found.append((x, y, z))
        return tuple(found)

    def within(self, field: str) -> "DefinitionEntry":
        """The object in a field."""
        return DefinitionEntry(f"{self.name}: {field}", self.value(field, dict))

    def fail(self, field: str, fault: str) -> NoReturn:
        """Raise the error that this field is at fault."""
        message = f"{self.name}: {field} {fault}."
        raise DefinitionError(message)
