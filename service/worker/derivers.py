"""What derives a kind: ``derive`` of the module of :mod:`service.worker.derived` named like it.

It is imported where a job asks for it: what it loads no fit needs, and every process forked for a
fit would carry it along.
"""

import importlib
from collections.abc import Callable
from typing import Any, Protocol

from api_schemas.derivation_kinds.base import DerivedFiles
from service.worker import derived
from service.worker.pipeline_port import DerivationInput, DerivationOutput


class Deriver(Protocol):
    """Makes what a kind's options ask for; its own are ``DerivationInput[PoseOptions]`` or so."""

    def __call__(
        self, job: DerivationInput[Any], observe: Callable[[float], None], /
    ) -> DerivationOutput[DerivedFiles]:
        """Derive something from a fit, and tell how much of it is done, from 0 to 1.

        Raises
        ------
        InvalidInputError
            If the request is at fault.
        """
        ...


def load_deriver(kind: str) -> Deriver:
    """Import what derives this kind."""
    return importlib.import_module(f"{derived.__name__}.{kind}").derive
