"""Which module derives what.

They are imported where a job asks for them: what they load no fit needs, and every process forked
for a fit would carry it along.
"""

import importlib
from collections.abc import Callable, Mapping
from typing import Final, Protocol, cast

from api_schemas.derivation_kinds import DerivationKind
from service.engine.port import Report
from service.worker.pipeline_port import DerivationInput, DerivationOutput

MODULES: Final[Mapping[DerivationKind, str]] = {
    DerivationKind.ANIMATION: "service.worker.derived.animation",
    DerivationKind.CARICATURE: "service.worker.derived.caricature",
    DerivationKind.COMBINED: "service.worker.derived.combined",
    DerivationKind.FIGURE: "service.worker.derived.figure",
    DerivationKind.POSE: "service.worker.derived.pose",
    DerivationKind.TEXTURE: "service.worker.derived.texture",
    DerivationKind.REPORT: "service.worker.report",
}


class Deriver(Protocol):
    """A module with this function."""

    def derive(self, job: DerivationInput, observe: Callable[[Report], None]) -> DerivationOutput:
        """Derive something from a fit.

        Raises
        ------
        InvalidInputError
            If the request is at fault.
        """
        ...


def load_deriver(kind: DerivationKind) -> Deriver:
    """Import what derives this kind."""
    return cast("Deriver", importlib.import_module(MODULES[kind]))
