"""Whether held-out figures made now are those that the model's header keeps from its build."""

from collections.abc import Mapping

import numpy as np

from fitter.training.report.held_out_errors import header_entry
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import table_lines

TOLERANCE = 1e-3
"""Of every figure: micrometres, and thousandths of a correlation. Single precision is finer."""


def disagreements(reported: Reported) -> dict[str, tuple[float, float]]:
    """Figures that differ, by name: the header's and that of now; a lacking one is not a number."""
    kept = reported.model.header.get("held_out_errors")
    claimed = kept if isinstance(kept, Mapping) else {}
    found = header_entry(reported.errors)
    pairs = {
        name: (float(claimed.get(name, np.nan)), float(found.get(name, np.nan)))
        for name in (found | dict(claimed))
    }
    # Written so that what is not a number differs.
    return {name: pair for name, pair in pairs.items() if not abs(pair[0] - pair[1]) <= TOLERANCE}


def agreement_lines(reported: Reported) -> tuple[str, ...]:
    """One line if the header and the held-out subjects at hand agree; else what differs.

    They do not when the file was built from other subjects than these: figures below that need
    held-out subjects are then not of subjects this model has not seen.
    """
    found = disagreements(reported)
    if not found:
        return ("  the header's held-out figures, made again: the same",)
    return table_lines(
        "the header's held-out figures, made again: DIFFERENT",
        ("", "header", "now"),
        [(name, *(f"{value:.4f}" for value in pair)) for name, pair in found.items()],
    )
