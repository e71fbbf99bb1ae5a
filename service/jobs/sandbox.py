"""What a sandbox can be asked to make of a job, by the label of its request."""

import re
from collections.abc import Mapping
from enum import StrEnum
from typing import Final

from fitter.vocabulary.outcomes import Verdict

MARK: Final = "sandbox:"
"""How a label begins that asks for something."""

FOR_DERIVATIONS: Final = "derivations:"
"""Goes on so if it is meant for what is derived: then the job itself ends as usual."""

SLOW: Final = "slow"
WARNINGS: Final = "warnings"
USUAL_SLOWNESS_S: Final = 20
MOST_SLOWNESS_S: Final = 300
"""Half of the time that a job may usually take."""

VERDICTS: Final[Mapping[str, Verdict]] = {
    verdict.value.replace("_", "-"): verdict
    for verdict in Verdict
    if verdict is not Verdict.PLAUSIBLE
}
"""Results without measurements."""

BY_ACCIDENT: Final = (
    "fit-failed",
    "fit-crashed",
    "input-gone",
    "no-process",
    "out-of-memory",
    "storage-full",
    "storage-unavailable",
    "time-limit-exceeded",
)
"""Codes of problems that are no fault of what was sent."""

UNUSABLE_PICTURES: Final[Mapping[str, str]] = {
    "contradictory-measurements": "weight_kg",
    "detector-not-installed": "points",
    "image-damaged": "image",
    "image-unsupported": "image",
    "mask-without-foreground": "mask",
    "person-not-found": "image",
    "points-too-close": "points",
}
"""Codes of what a fit or a scan cannot use, and the field at fault."""

OF_A_VIEW: Final = frozenset(UNUSABLE_PICTURES.values()) - {"weight_kg"}
"""Fields that are those of one view of a scan."""

UNUSABLE_FOR_DERIVATIONS: Final[Mapping[str, str]] = {
    "bvh-unreadable": "bvh",
    "fits-unusable": "kind",
    "no-light": "colours",
    "texture-size": "texture",
}
"""Codes of what a derivation cannot use, and the field at fault."""

_SLOW: Final = re.compile(rf"{SLOW}(?::([1-9]\d{{0,2}}))?")


class Whose(StrEnum):
    """Whose ending it is."""

    PICTURES = "fits and scans"
    DERIVATIONS = "derivations"


ENDINGS: Final[Mapping[Whose, tuple[str, ...]]] = {
    Whose.PICTURES: (SLOW, WARNINGS, *VERDICTS, *BY_ACCIDENT, *UNUSABLE_PICTURES),
    Whose.DERIVATIONS: (SLOW, *BY_ACCIDENT, *UNUSABLE_FOR_DERIVATIONS),
}
"""All that there is."""


def is_known(ending: str, whose: Whose) -> bool:
    """Whether there is such an ending; a slow one may say how slow, ``slow:5``."""
    return ending in ENDINGS[whose] or slowness_s(ending) is not None


def slowness_s(ending: str) -> int | None:
    """For how many seconds the job is to run, None if it is not asked to be slow."""
    found = _SLOW.fullmatch(ending)
    if found is None:
        return None
    asked = int(found[1] or USUAL_SLOWNESS_S)
    return asked if asked <= MOST_SLOWNESS_S else None
