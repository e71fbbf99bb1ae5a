"""What makes the products of a fit: ``make`` in the module that has the name of the kind.

A module is imported only when its product is asked for: no fit needs what it loads, and every
process forked for a fit would carry it along.
"""

import importlib
from collections.abc import Callable
from typing import Any, Protocol

from api_schemas.products.base import ProductResult
from service.compute.products.finished_fit import FinishedFit, Made

Report = Callable[[float], None]
"""Tells how much of the work is done, from 0 to 1."""


class Maker(Protocol):
    """Makes what the options of a kind ask for; each takes its own, say ``PoseOptions``."""

    def __call__(self, fit: FinishedFit, options: Any, report: Report, /) -> Made[ProductResult]:
        """Make a product.

        Raises
        ------
        InvalidInputError
            If the request is at fault.
        """
        ...


def maker_of(kind: str) -> Maker:
    """Import what makes products of a kind."""
    return importlib.import_module(f"{__name__}.{kind}").make
