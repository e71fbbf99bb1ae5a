"""The tables beside that of the suite's fits, each by the option of its name."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from fitter.vocabulary.choices import Clothing
from tests.accuracy.cases import PEOPLE
from tests.accuracy.clothing_table import case_heading, clothing_lines, underwear_lines
from tests.accuracy.clothing_table import case_lines as dressed_lines
from tests.accuracy.dressed import MISSING, dressed_names
from tests.accuracy.dressed_scores import DressedScore, score_dressed, score_undressed
from tests.accuracy.nulls import null_rows, null_table
from tests.accuracy.paper_method import method_errors, method_lines
from tests.accuracy.real_outfits import outfit_tables
from tests.accuracy.runs import of_each
from tests.accuracy.scans import pairs_of, scan_lines, scanned
from tests.accuracy.scene import Case, Half, Kind, Series
from tests.accuracy.spoilt import KINDS, asked_spoilt, measured, spoilt_heading, spoilt_lines


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


def spoilt(choice: Choice) -> None:
    """People who stand, in pictures spoilt in one way each; each kind as soon as it is fitted."""
    for half, cases in choice.cases_by_half.items():
        names = [each.name for each in cases if each.name.endswith(f"_{Kind.STANDING}")]
        if names:
            _print([*null_table(names), "", spoilt_heading()], f"{half} half")
        for kind in choice.options.kind or KINDS:
            found = of_each(measured, asked_spoilt(names, [kind]), choice.jobs)
            _print(spoilt_lines(list(found)))


def scan(choice: Choice) -> None:
    """People from the front, from the side and from both; of one set if one is asked for."""
    proposed = choice.options.proposed
    for half in choice.halves:
        for series in (Series.PHONE, Series.CLOTHED_PAIRS, Series.FOREIGN):
            pairs = pairs_of(series, half)
            if pairs and choice.options.set in (None, series):
                found = of_each(partial(scanned, proposed=proposed), pairs, choice.jobs)
                lines = scan_lines([each for several in found for each in several])
                by = "proposals" if proposed else "clicks"
                title = f"{series} set, {half} half: {len(pairs)} people, {by}"
                _print([*lines, *null_table([pair.front for pair in pairs])], title)


def dressed(choice: Choice) -> None:
    """People in clothes: nothing said, clothes said to be tight and loose, the weight given."""
    for half, cases in choice.cases_by_half.items():
        names = [case.name for case in cases]
        scores = _dressed(names, choice.jobs, f"{half} half")
        _print(null_rows(names))
        undressed = [f"{case.person}_{Kind.STANDING}" for case in cases]
        _print(underwear_lines(scores, score_undressed(undressed, jobs=choice.jobs)))


def dressed_strangers(choice: Choice) -> None:
    """The same of bodies by another maker."""
    names = dressed_names()
    if not names:
        print(MISSING, flush=True)
        return
    _dressed(names, choice.jobs, "dressed set")
    _print(null_rows(names))


def _dressed(names: Sequence[str], jobs: int, title: str) -> list[DressedScore]:
    """Each picture as soon as it is fitted, then what they have in common."""
    _print([case_heading()], title)
    scores: list[DressedScore] = []
    for of_picture in score_dressed(names, jobs=jobs):
        _print(dressed_lines(of_picture))
        scores += of_picture
    _print(["", *clothing_lines(scores)])
    return scores


def outfits(choice: Choice) -> None:
    """Real people in two outfits each, in a folder, from the front and from behind."""
    clothing = Clothing(choice.options.clothing or Clothing.AUTO)
    _print(outfit_tables(choice.options.outfits, clothing, choice.jobs))


Mode = Callable[[Choice], None]

MODES: Mapping[str, Mode] = {
    "paper": paper,
    "spoilt": spoilt,
    "scan": scan,
    "outfits": outfits,
}


def mode_of(options: argparse.Namespace) -> Mode | None:
    """What is asked for, None for scores."""
    asked = [mode for name, mode in MODES.items() if getattr(options, name)]
    if asked:
        return asked[0]
    if options.set == Series.DRESSED.value:
        return dressed_strangers
    each = options.set == Series.CLOTHED.value and options.clothing is None
    return dressed if each else None


def _print(lines: Sequence[str], title: str | None = None) -> None:
    heading = [] if title is None else ["", title]
    print("\n".join([*heading, *lines]), flush=True)
