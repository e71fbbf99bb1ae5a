"""Content negotiation: what an Accept header prefers of what is offered (RFC 9110 12.5.1)."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from api_schemas.problems import problem
from service.api.problems import ProblemError

ANYTHING: Final = "*/*"
OCTETS: Final = "application/octet-stream"
"""Matches every file: a client that accepts bytes accepts any file."""

LONGEST_QUOTED: Final = 100
"""How many characters of a header a problem quotes."""

_RANGE: Final = re.compile(r"^([\w!#$&^.+*-]+)/([\w!#$&^.+*-]+)$")
_WEIGHT: Final = re.compile(r"^[qQ]\s*=\s*(0(?:\.\d{0,3})?|1(?:\.0{0,3})?)$")


@dataclass(frozen=True, slots=True, kw_only=True)
class MediaRange:
    """An entry of the header: which types, their weight, and its position."""

    kind: str
    weight: float
    place: int

    def matches(self, media_type: str) -> bool:
        """Whether it includes this type."""
        family, _, _ = media_type.partition("/")
        return self.kind in (ANYTHING, f"{family}/*", media_type)

    @property
    def specificity(self) -> int:
        """How specific the range is: the more specific of two decides."""
        return 2 - self.kind.count("*")


def preferred(accept: str | None, offered: Sequence[str]) -> str | None:
    """Choose the offered type that is preferred most; None if none is acceptable.

    Of types with equal weight, the one asked for more specifically wins, then the one named first,
    then the one offered first. An empty header accepts anything.
    """
    ranges = list(_ranges(accept or ""))
    if not ranges:
        return offered[0]
    ranked = [
        (each.weight, each.specificity, -each.place, -place, media_type)
        for place, media_type in enumerate(offered)
        if (each := _speaking_of(media_type, ranges)) is not None and each.weight > 0.0
    ]
    return max(ranked)[-1] if ranked else None


def not_acceptable(accept: str | None, *, what: str, offered: Sequence[str]) -> ProblemError:
    """Say that nothing acceptable is available, and what is."""
    return ProblemError(
        problem(
            "not-acceptable",
            detail=f"{what} cannot be had as {_shortened(accept)}.",
            remedy=f"Ask for one of {', '.join(offered)}, or leave the header out.",
            field="Accept",
        ),
        headers={"Vary": "Accept"},
    )


def _shortened(accept: str | None) -> str:
    text = accept or ANYTHING
    return text if len(text) <= LONGEST_QUOTED else f"{text[:LONGEST_QUOTED]}..."


def _speaking_of(media_type: str, ranges: Sequence[MediaRange]) -> MediaRange | None:
    matching = [each for each in ranges if each.matches(media_type)]
    return max(matching, key=lambda each: (each.specificity, -each.place), default=None)


def _ranges(accept: str) -> Iterator[MediaRange]:
    """The entries that can be parsed; parameters other than the weight are ignored."""
    for place, part in enumerate(accept.split(",")):
        kind, *parameters = (each.strip() for each in part.split(";"))
        if not _RANGE.match(kind):
            continue
        weights = [found[1] for each in parameters if (found := _WEIGHT.match(each))]
        kind = kind.lower()
        yield MediaRange(
            kind=ANYTHING if kind == OCTETS else kind,
            weight=float(weights[0]) if weights else 1.0,
            place=place,
        )
