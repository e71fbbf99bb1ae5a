"""``python -m tests.accuracy``: fit the suite with SE and with SES and print the errors."""

import argparse
import sys
from collections.abc import Sequence

from fitter.vocabulary.choices import Clothing, Cues
from tests.accuracy.body_tables import bmi_lines
from tests.accuracy.cases import CASES, PEOPLE
from tests.accuracy.command_line import parser
from tests.accuracy.foreign import MISSING, foreign_names
from tests.accuracy.modes import Choice, mode_of
from tests.accuracy.nulls import null_table
from tests.accuracy.page import write_page
from tests.accuracy.runs import Run, score_all
from tests.accuracy.scene import PAIRED_SERIES, Case, Half, Series
from tests.accuracy.scoring import Scored
from tests.accuracy.table import case_lines, summary_lines, worst_lines
from tests.accuracy.true_picture import Told


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    asked = parser(__doc__)
    options = asked.parse_args(arguments)
    if options.proposed and not options.scan:
        asked.error("--proposed goes with --scan")
    if options.kind and not options.spoilt:
        asked.error("--kind goes with --spoilt")
    choice = Choice(
        cases=[case for case in CASES.values() if _is_chosen(case, options)],
        foreign=_foreign(options),
        options=options,
    )
    mode = mode_of(options) or _score
    mode(choice)
    return 0


def _score(choice: Choice) -> None:
    """Fit every picture, one line each, then what the fits have in common."""
    options = choice.options
    run = Run(
        told=Told(
            mask=options.true_mask,
            focal_length=options.known_focal,
            measurements=tuple(options.given or ()),
            clothing=Clothing(options.clothing or Clothing.AUTO),
        ),
        pictures=options.page,
    )
    scored: list[Scored] = []
    names = [*(case.name for case in choice.cases), *choice.foreign]
    for pair in score_all(names, run, jobs=choice.jobs):
        lines = case_lines(pair)
        print("\n".join(lines[1:] if scored else lines), flush=True)
        scored += pair
    for title, part in _parts(scored):
        print(f"\n{title}: {_counts(part)}")
        for lines in (summary_lines, bmi_lines, worst_lines):
            print("\n".join(lines(part)))
        print("\n".join(null_table([each.name for each in part])))
    if options.page is not None:
        print(f"\n{write_page(options.page, scored)}")


def _is_chosen(case: Case, options: argparse.Namespace) -> bool:
    if options.case:
        return case.name in options.case
    in_set = case.series.value == options.set
    if options.set is None:
        in_set = case.series not in PAIRED_SERIES
    return in_set and options.half in (None, PEOPLE[case.person].half.value)


def _foreign(options: argparse.Namespace) -> list[str]:
    """The foreign pictures that are chosen, in a folder that may not be there."""
    half = None if options.half is None else Half(options.half)
    wanted = options.set in (None, Series.FOREIGN.value) or options.paper
    if wanted and not options.case and not foreign_names():
        print(MISSING, flush=True)
    if options.case:
        return [name for name in foreign_names() if name in options.case]
    return foreign_names(half) if wanted else []


def _parts(scored: Sequence[Scored]) -> list[tuple[str, list[Scored]]]:
    """What is summed up apart: the halves of people and foreigners, then all of each other set."""
    of = {series: [each for each in scored if each.series is series] for series in Series}
    parts = [
        (f"{half.value} half", [each for each in of[Series.PEOPLE] if each.half is half])
        for half in Half
    ]
    parts += [
        (f"{series.value} set", of[series])
        for series in (Series.LIGHTS, Series.CLOTHED, Series.SAMPLE)
    ]
    parts += [
        (
            f"{series.value} set, {half.value} half",
            [each for each in of[series] if each.half is half],
        )
        for series in Series
        if series in PAIRED_SERIES
        for half in Half
    ]
    parts += [
        (f"foreign, {half.value} half", [each for each in of[Series.FOREIGN] if each.half is half])
        for half in Half
    ]
    if len({each.half for each in of[Series.FOREIGN]}) > 1:
        parts.append(("foreign set", of[Series.FOREIGN]))
    return [(title, part) for title, part in parts if part]


def _counts(scored: Sequence[Scored]) -> str:
    people = len({each.person for each in scored})
    return f"people {people}, pictures {len(scored) // len(Cues)}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
