"""MEASUREMENTS.md: what is measured, and how that stands to standard and survey.

``python -m fitter.measurement.document`` prints the page, from the definitions. Its pictures are
drawn by ``python -m fitter.training.report.measurement_atlas``.
"""

import sys
from collections.abc import Sequence

from fitter.measurement.definitions import (
    Agreement,
    IsoDefinition,
    MeasurementDefinition,
    SurveyDefinition,
    load_definitions,
)
from fitter.vocabulary.measurements import Group, group_of

_HEADING = """# Measurements

Every measurement of the service, where its tape runs, its definition, and where it agrees with two
others: ISO 8559-1:2017, the tailors' standard, and ANSUR II, the US Army's survey of 2012 (fields
of the public release, NATICK/TR-15/007). What the survey's handbook says of each stands in
`fitter/measurement/definitions.json`, from which `python -m fitter.measurement.document` makes this
page.

Bodies are measured in the canonical pose (upright, arms 40 and legs 7 degrees from straight down,
elbows and knees straight), heights in the standing pose, limbs on the right. A girth is the convex
hull of a plane cut, because a tape spans hollows; it does not press. Where no landmark is, a point
is where a ray from inside the average body leaves the skin.

The pictures show the average woman; what she hides of a tape is pale. `python -m fitter.training
report` prints how far values, spreads and correlations are from the survey's.
"""

ATLAS_FOLDER = "fitter/measurement/atlas"
"""From the page, at the root of the repository: a picture of each group's tapes on the body."""

_AGREEMENT = {
    Agreement.SAME: "as there",
    Agreement.DIFFERS: "differs",
}


def sheet_name(group: Group) -> str:
    """The file of a group's picture."""
    return f"{group.name.lower()}.webp"


def measurements_page(definitions: Sequence[MeasurementDefinition]) -> str:
    """The page, in Markdown."""
    lines = [_HEADING]
    for group in Group:
        members = [each for each in definitions if group_of(each.about.name) is group]
        lines += [
            f"## {group.value}\n",
            f"![Each tape on the body, under its name]({ATLAS_FOLDER}/{sheet_name(group)})\n",
            "| measurement | here | ISO 8559-1 | ANSUR II |",
            "|---|---|---|---|",
            *(_row(each) for each in members),
            "",
        ]
    return "\n".join(lines).rstrip("\n") + "\n"


def _row(definition: MeasurementDefinition) -> str:
    about = definition.about
    return (
        f"| `{about.name}` ({about.unit.value}) | {about.definition} | {_iso(about.iso)} | "
        f"{_survey(about.survey)} |"
    )


def _iso(iso: IsoDefinition | None) -> str:
    if iso is None:
        return "-"
    clause = "" if iso.clause is None else f" ({iso.clause})"
    return f"{iso.term}{clause}. *{_AGREEMENT[iso.agreement].capitalize()}:* {iso.difference}"


def _survey(survey: SurveyDefinition) -> str:
    if survey.agreement is Agreement.ABSENT:
        return "-"
    fields = " + ".join(f"`{field}`" for field in survey.fields)
    agreement = _AGREEMENT[survey.agreement].capitalize()
    return f"{fields}. *{agreement}:* {survey.difference}"


if __name__ == "__main__":
    sys.stdout.write(measurements_page(load_definitions()))
