"""``python -m tests.evaluation``: fit the suite with SE and with SES and print the errors."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from fitter.request import Cues
from tests.evaluation.cases import CASES, PEOPLE
from tests.evaluation.people import load_person
from tests.evaluation.scene import Case, Half
from tests.evaluation.shape_limit import shape_limit
from tests.evaluation.sheets import write_sheet
from tests.evaluation.suite import Scored, score_case
from tests.evaluation.table import case_lines, limit_lines, summary_lines


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    chosen = [CASES[name] for name in options.case or CASES]
    chosen = [case for case in chosen if options.half in (None, _half(case).value)]
    if options.shape_limit:
        people = {case.person: PEOPLE[case.person] for case in chosen}
        limits = {name: shape_limit(load_person(source)) for name, source in people.items()}
        print("\n".join(limit_lines(limits)))
        return 0
    scored: list[Scored] = []
    for case in chosen:
        for cues in Cues:
            each = score_case(case, cues, true_mask=options.true_mask)
            scored.append(each)
            lines = case_lines([each])
            print("\n".join(lines if len(scored) == 1 else lines[1:]), flush=True)
            if options.pictures is not None:
                write_sheet(options.pictures, each)
    for half in Half:
        of_half = [each for each in scored if each.half is half]
        if of_half:
            people = len({each.case.person for each in of_half})
            print(f"\n{half.value} half: {people} people, {len(of_half) // len(Cues)} pictures")
            print("\n".join(summary_lines(of_half)))
    return 0


def _half(case: Case) -> Half:
    return PEOPLE[case.person].half


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.evaluation", description=__doc__)
    parser.add_argument(
        "--half",
        choices=[half.value for half in Half],
        help="choose constants on tuning, report figures on reporting (default: both)",
    )
    parser.add_argument("--case", action="append", choices=list(CASES), help="default: all")
    parser.add_argument(
        "--pictures", type=Path, metavar="DIR", help="write a sheet of pictures for each fit"
    )
    parser.add_argument(
        "--true-mask",
        action="store_true",
        help="give the person's true mask: what the errors would be without segmentation",
    )
    parser.add_argument(
        "--shape-limit",
        action="store_true",
        help="fit nothing: print what the shape space's own coarseness costs",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
