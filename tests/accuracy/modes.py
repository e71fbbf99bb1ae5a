"""What the evaluation can do beside scoring fits, each by the option of its name."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby

from tests.accuracy.capture_table import capture_lines, judged_by, judgements
from tests.accuracy.cases import PEOPLE
from tests.accuracy.clothes_check import clothed_pictures, clothes_lines, clothes_said
from tests.accuracy.clothing_table import (
    case_heading,
    clothing_lines,
    underwear_lines,
)
from tests.accuracy.clothing_table import (
    case_lines as dressed_lines,
)
from tests.accuracy.covers import asked_covers, covered_fit
from tests.accuracy.covers_table import covers_heading, covers_line
from tests.accuracy.dressed import MISSING, dressed_names
from tests.accuracy.dressed_scores import DressedScore, score_dressed, score_undressed
from tests.accuracy.foreign import MISSING as FOREIGN_MISSING
from tests.accuracy.foreign import foreign_half
from tests.accuracy.nulls import null_rows, null_table
from tests.accuracy.painted_clothes import painted_names
from tests.accuracy.paper_method import method_errors, method_lines
from tests.accuracy.runs import of_each
from tests.accuracy.scan_tables import scan_lines, worst_scan_lines
from tests.accuracy.scans import (
    Pair,
    Scanned,
    clothed_pairs,
    foreign_pairs,
    own_pairs,
    scanned,
)
from tests.accuracy.scene import Case, Half, Series
from tests.accuracy.spoilt import KINDS, asked_spoilt, measured
from tests.accuracy.spoilt_table import spoilt_heading, spoilt_lines
from tests.accuracy.stance_kinds import Kind

EVERY = 2
"""Of people in this order as many are left out."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Choice:
    """The pictures that were chosen, the suite's own and foreign ones by name, and all options."""

    cases: Sequence[Case]
    foreign: Sequence[str]
    options: argparse.Namespace

    @property
    def jobs(self) -> int:
        """Processes."""
        return self.options.jobs

    @property
    def halves(self) -> Sequence[Half]:
        """The half that was asked for, or both."""
        return list(Half) if self.options.half is None else [Half(self.options.half)]

    @property
    def cases_by_half(self) -> Mapping[Half, Sequence[Case]]:
        """Without halves that have none."""
        of = {
            half: [case for case in self.cases if PEOPLE[case.person].half is half] for half in Half
        }
        return {half: cases for half, cases in of.items() if cases}

    @property
    def people_cases(self) -> Sequence[Case]:
        """Those of everybody's ordinary pictures."""
        return [case for case in self.cases if case.series is Series.PEOPLE]


def paper(choice: Choice) -> None:
    """By the paper's own method, by that with what was added to it, and by ours."""
    people = [case.name for case in choice.people_cases]
    for title, names in (("suite", people), ("foreign", choice.foreign)):
        if names:
            found = of_each(method_errors, names, choice.jobs)
            _print(method_lines([each for several in found for each in several]), title)


def checks(choice: Choice) -> None:
    """What the checks of a capture find, and what is not wrong."""
    for half in choice.halves:
        tasks = judgements(_names(choice, half), half)
        judged = of_each(judged_by, tasks, choice.jobs)
        lines = capture_lines([each for several in judged for each in several])
        _print(lines, f"{half.value} half")
    asked = [each for half in choice.halves for each in clothed_pictures(half)]
    _print(clothes_lines(list(of_each(clothes_said, list(dict.fromkeys(asked)), choice.jobs))), "")


def spoilt(choice: Choice) -> None:
    """People who stand, in pictures spoilt in one way each; each kind as soon as it is fitted."""
    for half, cases in choice.cases_by_half.items():
        names = [each.name for each in cases if each.name.endswith(f"_{Kind.STANDING.value}")]
        if names:
            _print([*null_table(names), "", spoilt_heading()], f"{half.value} half")
        for kind in choice.options.kind or KINDS:
            found = list(of_each(measured, asked_spoilt(names, [kind]), choice.jobs))
            _print(spoilt_lines(found))


def covers(choice: Choice) -> None:
    """Every second person in underwear and in clothes, with what hides skin or looks like it."""
    for half, cases in choice.cases_by_half.items():
        standing = [each.name for each in cases if each.name.endswith(f"_{Kind.STANDING.value}")]
        clothed = [each.name for each in cases if each.series is Series.CLOTHED]
        found = of_each(covered_fit, asked_covers(standing[::EVERY], clothed[::EVERY]), choice.jobs)
        _print([covers_heading()], f"{half.value} half")
        for _, these in groupby(found, key=lambda each: (each.dressed, each.asked.kind)):
            _print([covers_line(list(these))])


def scan(choice: Choice) -> None:
    """People from the front, from the side and from both; of one set if one is asked for."""
    for half in choice.halves:
        for series, pairs in (
            (Series.PHONE, own_pairs(half)),
            (Series.CLOTHED_PAIRS, clothed_pairs(half)),
            (Series.FOREIGN, foreign_pairs(half)),
        ):
            if pairs and choice.options.set in (None, series.value):
                proposed = choice.options.proposed
                found = _scans(pairs, choice.jobs, proposed=proposed)
                nulls = null_table([pair.front for pair in pairs])
                lines = [*scan_lines(found), *nulls, "", *worst_scan_lines(found)]
                by = "proposals" if proposed else "clicks"
                _print(lines, f"{series.value} set, {half.value} half: {len(pairs)} people, {by}")


def dressed(choice: Choice) -> None:
    """People in clothes: nothing said, clothes said to be tight and loose, the weight given."""
    for half, cases in choice.cases_by_half.items():
        names = [case.name for case in cases]
        scores = _dressed(names, choice.jobs, f"{half.value} half")
        _print(null_rows(names))
        undressed = [f"{case.person}_{Kind.STANDING.value}" for case in cases]
        _print(underwear_lines(scores, score_undressed(undressed, jobs=choice.jobs)))


def dressed_strangers(choice: Choice) -> None:
    """The same of bodies by another maker."""
    names = dressed_names()
    if not names:
        print(MISSING, flush=True)
        return
    _dressed(names, choice.jobs, "dressed set")
    _print(null_rows(names))


def painted_strangers(choice: Choice) -> None:
    """Clothes as close as paint."""
    names = painted_names()
    if not names:
        print(FOREIGN_MISSING, flush=True)
        return
    _dressed(names, choice.jobs, "painted set")


def _dressed(names: Sequence[str], jobs: int, title: str) -> list[DressedScore]:
    """Each picture as soon as it is fitted, then what they have in common."""
    _print([case_heading()], title)
    scores: list[DressedScore] = []
    for of_picture in score_dressed(names, jobs=jobs):
        _print(dressed_lines(of_picture))
        scores += of_picture
    _print(["", *clothing_lines(scores)])
    return scores


Mode = Callable[[Choice], None]

MODES: Mapping[str, Mode] = {
    "paper": paper,
    "checks": checks,
    "spoilt": spoilt,
    "covers": covers,
    "scan": scan,
}


def mode_of(options: argparse.Namespace) -> Mode | None:
    """What is asked for, None for scores."""
    asked = [mode for name, mode in MODES.items() if getattr(options, name)]
    if asked:
        return asked[0]
    if options.set == Series.DRESSED.value:
        return dressed_strangers
    if options.set == Series.PAINTED.value:
        return painted_strangers
    each = options.set == Series.CLOTHED.value and options.clothing is None
    return dressed if each else None


def _names(choice: Choice, half: Half) -> list[str]:
    """The chosen pictures of a half, foreign ones too."""
    own = [case.name for case in choice.cases_by_half.get(half, ())]
    return own + [each for each in choice.foreign if foreign_half(each) is half]


def _scans(pairs: Sequence[Pair], jobs: int, *, proposed: bool = False) -> list[Scanned]:
    found = of_each(partial(scanned, proposed=proposed), pairs, jobs)
    return [each for several in found for each in several]


def _print(lines: Sequence[str], title: str | None = None) -> None:
    heading = [] if title is None else ["", title]
    print("\n".join([*heading, *lines]), flush=True)
