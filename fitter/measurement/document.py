"""MEASUREMENTS.md: what is measured, and how that stands to the survey, from the definitions.

``python -m fitter.measurement.document`` prints the page.
"""

import sys
from collections.abc import Sequence

from fitter.measurement.definition_file import load_definitions
from fitter.measurement.definitions import Agreement, MeasurementDefinition
from fitter.measurement.groups import Group

_HEADING = """# Measurements

Every measurement of the service, its definition, and where it agrees with ANSUR II, the US Army's
anthropometric survey of 2012, as its measurer's handbook has it (Hotzman et al. 2011,
NATICK/TR-11/017; fields as in the public release, Gordon et al. 2014, NATICK/TR-15/007). Made from
`fitter/measurement/definitions.json` by `python -m fitter.measurement.document`.

What holds for all: bodies are measured in the canonical pose (upright, arms 40 and legs 7 degrees
from straight down, elbows and knees straight), heights in the standing pose; the right limbs are
taken, as in the survey. A girth is the convex hull of a plane cut, because a tape spans hollows; it
does not press. Nobody breathes, wears or tenses anything.

How far values, spreads and correlations are from the survey's: `python -m fitter.training report`.
"""

_AGREEMENT = {
    Agreement.SAME: "as the survey",
    Agreement.DIFFERS: "differs",
    Agreement.ABSENT: "not in the survey",
}

ATLAS_FOLDER = "atlas"
"""Beside the page: a picture of each group's tapes on the body."""


def sheet_name(group: Group) -> str:
    """The file of a group's picture."""
    return f"{group.name.lower()}.webp"


def measurements_page(definitions: Sequence[MeasurementDefinition]) -> str:
    """The page, in Markdown."""
    lines = [_HEADING, "| measurement | here | ANSUR II | |", "|---|---|---|---|"]
    for definition in definitions:
        about, survey = definition.about, definition.about.survey
        fields = " + ".join(f"`{field}`" for field in survey.fields)
        lines.append(
            f"| `{about.name}` ({about.unit.value}) | {about.definition} | "
            f"{fields}{': ' if fields else ''}{survey.definition} | "
            f"{_AGREEMENT[survey.agreement]}: {survey.difference} |"
        )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(measurements_page(load_definitions()))
