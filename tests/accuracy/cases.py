"""The suite's cases: whom each picture shows, how they stand, what they wear, where, in what light.

One file holds them, a line each, as they were drawn from seeds once. What a line leaves out is as
:mod:`tests.accuracy.scene` has it. A new picture is a new line.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, is_dataclass
from pathlib import Path
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

from tests.accuracy.people_table import PEOPLE
from tests.accuracy.scene import Case, Series

__all__ = ("CASES", "CLOTHED_PAIRS", "DEMO", "PEOPLE", "PHONE_PAIRS")

CASES_FILE = Path(__file__).parent / "data" / "cases.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class PicturePair:
    """One person from the front and from the side, in one room and light."""

    front: Case
    side: Case

    @property
    def person(self) -> str:
        """The person's name."""
        return self.front.person


def read_cases(path: Path = CASES_FILE) -> dict[str, Case]:
    """The cases of a file, by name."""
    cases = [_read(Case, each) for each in json.loads(path.read_text())]
    return {case.name: case for case in cases}


def _read(kind: Any, value: Any) -> Any:
    """A value of JSON as what a field of this kind holds."""
    (kind, *_) = [each for each in get_args(kind) if each is not NoneType] or [kind]
    if get_origin(kind) is tuple or isinstance(value, list):
        return tuple(value)
    if is_dataclass(kind):
        kinds = get_type_hints(kind)
        return kind(**{name: _read(kinds[name], each) for name, each in value.items()})
    return kind(value)


CASES: Mapping[str, Case] = read_cases()

DEMO = CASES["demo"]

PHONE_PAIRS: Mapping[str, PicturePair] = {
    case.name.removesuffix("_front"): PicturePair(
        front=case, side=CASES[f"{case.name.removesuffix('_front')}_side"]
    )
    for case in CASES.values()
    if case.series is Series.PHONE and case.name.endswith("_front")
}
"""One pair of each person, as a phone held upright sees them; ``phone_`` and the name."""

CLOTHED_PAIRS: Mapping[str, PicturePair] = {
    case.person: PicturePair(front=CASES[case.name.removesuffix("_side")], side=case)
    for case in CASES.values()
    if case.series is Series.CLOTHED_PAIRS
}
"""People in their clothes whose one picture is from the front, with another from the side."""
