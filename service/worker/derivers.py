"""Finds what derives a kind: ``derive`` in the module of :mod:`service.worker.derived` of its name.

It is imported only when a job asks for it: no fit needs what it loads, and every process forked for
a fit would carry it along.
"""

import importlib
from collections.abc import Callable
from typing import Any, Protocol

from api_schemas.derivation_kinds.base import DerivedFiles
from service.worker import derived
from service.worker.pipeline_port import DerivationInput, DerivationOutput


class Deriver(Protocol):
    """Makes what the options of a kind ask for; each takes its own, say ``PoseOptions``."""

    def __call__(
        self, job: DerivationInput[Any], observe: Callable[[float], None], /
    ) -> DerivationOutput[DerivedFiles]:
        """Derive something from a fit, and report how much of it is done, from 0 to 1.

        Raises
        ------
        InvalidInputError
            If the request is at fault.
        """
        ...


def load_deriver(kind: str) -> Deriver:
    """Import what derives this kind."""
    return importlib.import_module(f"{derived.__name__}.{kind}").derive
