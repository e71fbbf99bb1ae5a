"""The wording of every language a report can be had in."""

from collections.abc import Mapping
from typing import Final

from api_schemas.derivation_kinds.report import Language
from service.worker.derived.report.english import ENGLISH
from service.worker.derived.report.german import GERMAN
from service.worker.derived.report.wording import Wording

WORDINGS: Final[Mapping[Language, Wording]] = {
    Language.ENGLISH: ENGLISH,
    Language.GERMAN: GERMAN,
}
