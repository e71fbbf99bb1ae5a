"""``python -m tests.accuracy``: fit the suite with SE and with SES and print the errors."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from fitter.vocabulary.choices import Clothing, Cues
from tests.accuracy.cases import CASES, PEOPLE
from tests.accuracy.foreign import MISSING, foreign_names
from tests.accuracy.modes import Choice, mode_of
from tests.accuracy.nulls import null_table
from tests.accuracy.runs import Run, score_all
from tests.accuracy.scene import PAIRED_SERIES, Case, Half, Series
from tests.accuracy.scoring import Scored
from tests.accuracy.spoilt import KINDS
from tests.accuracy.table import MEASUREMENTS, bmi_lines, case_lines, summary_lines, worst_lines
from tests.accuracy.true_picture import Told


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    asked = parser()
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


def parser() -> argparse.ArgumentParser:
    """Options that choose pictures, what fits are told, or another table."""
    found = argparse.ArgumentParser(prog="python -m tests.accuracy", description=__doc__)
    add = found.add_argument
    add(
        "--half",
        choices=list(Half),
        help="choose constants on tuning, report figures on reporting (default: both)",
    )
    add("--set", choices=list(Series), help="default: all but the pairs from front and side")
    add(
        "--case",
        action="append",
        choices=[*CASES, *foreign_names()],
        metavar="NAME",
        help="these alone (default: all)",
    )
    add("--jobs", type=int, default=1, help="fits made side by side")
    add("--page", type=Path, metavar="DIR", help="draw every fit beside the truth, a file a case")
    add(
        "--true-mask",
        action="store_true",
        help="give the person's true mask: what the errors would be without segmentation",
    )
    add(
        "--clothing",
        choices=list(Clothing),
        help="how clothes are said to lie (default: auto; of clothed and dressed people each)",
    )
    add(
        "--known-focal",
        action="store_true",
        help="give the focal length in pixels, where it is in the file or missing too",
    )
    add(
        "--given",
        action="append",
        choices=[key for _, key, _ in MEASUREMENTS],
        help="give this measurement, as a caller of the service may; may be repeated",
    )
    add("--paper", action="store_true", help="fit by the paper's own method and by ours")
    add(
        "--spoilt",
        action="store_true",
        help="measure people behind things, cropped, told wrongly, in the dark: errors, findings",
    )
    add("--kind", action="append", choices=KINDS, metavar="KIND", help="with --spoilt: these alone")
    add("--outfits", type=Path, metavar="DIR", help="fit real people in two outfits each")
    add(
        "--scan",
        action="store_true",
        help="measure people from the front, from the side and from both, foreign ones too",
    )
    add("--proposed", action="store_true", help="with --scan: by the detector's points, no clicks")
    return found


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
        people = len({each.person for each in part})
        print(f"\n{title}: people {people}, pictures {len(part) // len(Cues)}")
        for lines in (summary_lines, bmi_lines, worst_lines):
            print("\n".join(lines(part)))
        print("\n".join(null_table([each.name for each in part])))


def _is_chosen(case: Case, options: argparse.Namespace) -> bool:
    if options.case:
        return case.name in options.case
    in_set = case.series == options.set
    if options.set is None:
        in_set = case.series not in PAIRED_SERIES
    return in_set and options.half in (None, PEOPLE[case.person].half)


def _foreign(options: argparse.Namespace) -> list[str]:
    """The foreign pictures that are chosen, in a folder that may not be there."""
    wanted = options.set in (None, Series.FOREIGN) or options.paper
    if wanted and not options.case and not foreign_names():
        print(MISSING, flush=True)
    if options.case:
        return [name for name in foreign_names() if name in options.case]
    half = None if options.half is None else Half(options.half)
    return foreign_names(half) if wanted else []


def _parts(scored: Sequence[Scored]) -> list[tuple[str, list[Scored]]]:
    """What is summed up apart: each set, and its halves where both are in it."""
    parts: list[tuple[str, list[Scored]]] = []
    for series in Series:
        of_series = [each for each in scored if each.series is series]
        halves = {half: [each for each in of_series if each.half is half] for half in Half}
        parts += [(f"{series} set, {half} half", each) for half, each in halves.items() if each]
        if all(halves.values()) and series is not Series.PEOPLE:
            parts.append((f"{series} set", of_series))
    return parts


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
