"""What there is to say of a kind of derivation: its types, what it is made of, its examples."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar
from uuid import UUID

from api_schemas.derivation_kinds import AnyDerivationOptions, DerivationKind
from api_schemas.derivation_kinds.base import DerivedFiles

Options = TypeVar("Options", bound=AnyDerivationOptions)
Result = TypeVar("Result", bound=DerivedFiles)


@dataclass(frozen=True, slots=True, kw_only=True)
class FormPart:
    """A file that may come along with a request, as a part of its form.

    ``check`` is given the file, what is asked for and the most pixels a picture may have. It
    returns the file's media type; of what cannot be used it raises
    :class:`service.submissions.refusal.RefusedError`.
    ``sent_for`` says in words which requests take the part.
    """

    name: str
    description: str
    media_types: str
    sent_for: str
    check: Callable[[bytes, AnyDerivationOptions, int], str]


@dataclass(frozen=True, slots=True, kw_only=True)
class Needs:
    """What a derivation is made of beside its request.

    Of the fit's inputs and files it has copies of those in ``of_fit``, so far as the fit has them.
    Of every one of ``other_fits``, by the fields of the request that name them, it has copies of
    those in ``of_others``.
    ``part`` may come along. Where it must, ``part_is_for`` goes on from "is missing, which".
    """

    of_fit: tuple[str, ...]
    other_fits: Mapping[str, UUID] = field(default_factory=dict[str, UUID])
    of_others: tuple[str, ...] = ()
    part: FormPart | None = None
    part_is_for: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DerivationKindDefinition(Generic[Options, Result]):
    """A kind of derivation, as its module of :mod:`service.api.derivation_kinds` declares it.

    ``part`` is what comes along with some of its requests. What needs a picture of a scan and names
    none in particular gets its first (:data:`service.jobs.inputs.OF_FIRST_VIEW`). The examples are
    those of the OpenAPI document: requests by name, and a result.
    """

    kind: DerivationKind
    options: type[Options]
    result: type[Result]
    needs: Callable[[Options], Needs]
    part: FormPart | None = None
    requests: Mapping[str, Any]
    answer: Mapping[str, Any]

    @property
    def is_measured(self) -> bool:
        """Whether its result has measurements, of which there is a table as well."""
        return "measurements" in self.result.model_fields
