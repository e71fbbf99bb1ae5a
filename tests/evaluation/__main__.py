"""``python -m tests.evaluation``: fit the suite with SE and with SES and print the errors."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from fitter.request import Clothing, Cues, Gender, OutlineKind
from tests.evaluation.body_tables import bmi_lines, distance_lines, trunk_lines
from tests.evaluation.capture_table import capture_lines, judged_by, judgements
from tests.evaluation.cases import CASES, PEOPLE
from tests.evaluation.chain import Link, chain_of
from tests.evaluation.chain_tables import chain_case_lines, chain_lines
from tests.evaluation.clothing_table import clothing_lines
from tests.evaluation.detector_figures import detector_lines, hinted_fits
from tests.evaluation.foreign import MISSING, foreign_half, foreign_names
from tests.evaluation.light_figures import InLight, in_both_lights, light_lines
from tests.evaluation.limit_tables import limit_lines, outline_lines, several_lines
from tests.evaluation.moved_points import moved_fits, moved_lines
from tests.evaluation.nonsense import nonsense
from tests.evaluation.outline_limit import outline_limit
from tests.evaluation.page import write_page
from tests.evaluation.people import load_person
from tests.evaluation.runs import Run, of_each, score_all, score_dressed
from tests.evaluation.scene import Case, Half, Series
from tests.evaluation.scoring import Scored
from tests.evaluation.several import several_pictures
from tests.evaluation.shape_limit import shape_limit
from tests.evaluation.table import MEASUREMENTS, case_lines, summary_lines, worst_lines
from tests.evaluation.true_picture import Told
from tests.evaluation.verdict_table import judged_nonsense, judged_picture, verdict_lines


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    chosen = [case for case in CASES.values() if _is_chosen(case, options)]
    foreign = _foreign(options)
    if options.shape_limit:
        people = {case.person: PEOPLE[case.person] for case in chosen}
        limits = {name: shape_limit(load_person(source)) for name, source in people.items()}
        print("\n".join(limit_lines(limits)))
        return 0
    if options.outline_limit:
        print("\n".join(outline_lines({each.value: outline_limit(each) for each in Gender})))
        return 0
    if options.several:
        names = [key for _, key, _ in MEASUREMENTS]
        for half in Half:
            people = [case for case in chosen if case.series is Series.PEOPLE]
            of_half = [case for case in people if PEOPLE[case.person].half is half]
            if of_half:
                print(f"\n{half.value} half")
                print("\n".join(several_lines(list(several_pictures(of_half, names)))))
        return 0
    if options.surroundings:
        in_light: list[InLight] = []
        for each in in_both_lights(chosen):
            line = case_lines([each.scored])[1]
            print(f"{each.surroundings.value:20s}{line}", flush=True)
            in_light.append(each)
        print("\n".join(light_lines(in_light)))
        return 0
    if options.chain and not foreign:
        return 0
    if options.chain:
        links: list[Link] = []
        for of_picture in of_each(chain_of, foreign, options.jobs):
            lines = chain_case_lines(of_picture)
            print("\n".join(lines[1:] if links else lines), flush=True)
            links += of_picture
        print("\n".join(chain_lines(links)))
        return 0
    if options.detector:
        people = [case.name for case in chosen if case.series is Series.PEOPLE]
        for title, names in (("suite", people), ("foreign", foreign)):
            if not names:
                continue
            hinted = of_each(hinted_fits, names, options.jobs)
            print(f"\n{title}")
            print("\n".join(detector_lines([each for several in hinted for each in several])))
        return 0
    if options.moved_points:
        fits = of_each(moved_fits, [case.name for case in chosen] + foreign, options.jobs)
        print("\n".join(moved_lines([each for several in fits for each in several])))
        return 0
    if options.checks:
        for half in [Half(options.half)] if options.half else list(Half):
            names = [case.name for case in chosen if PEOPLE[case.person].half is half]
            names += [each for each in foreign if foreign_half(each) is half]
            tasks = judgements(names, half)
            judged = of_each(judged_by, tasks, options.jobs)
            print(f"\n{half.value} half")
            print("\n".join(capture_lines([each for several in judged for each in several])))
        return 0
    if options.nonsense:
        for half in [Half(options.half)] if options.half else list(Half):
            names = [case.name for case in chosen if PEOPLE[case.person].half is half]
            names += [each for each in foreign if foreign_half(each) is half]
            judged = [
                *of_each(judged_picture, names, options.jobs),
                *of_each(judged_nonsense, nonsense(half, Cues.SES), options.jobs),
            ]
            print(f"\n{half.value} half")
            print("\n".join(verdict_lines([each for several in judged for each in several])))
        return 0
    if options.set == Series.CLOTHED.value and options.clothing is None:
        for title, part in _halves(chosen):
            print(f"\n{title}")
            print(
                "\n".join(
                    clothing_lines(score_dressed([case.name for case in part], jobs=options.jobs))
                )
            )
        return 0
    run = Run(
        told=Told(
            mask=options.true_mask,
            light=options.true_light,
            focal_length=options.known_focal,
            pose=options.true_pose or options.true_place,
            place=options.true_place,
            measurements=tuple(options.given or ()),
            outline=None if options.outline is None else OutlineKind(options.outline),
            clothing=Clothing(options.clothing or Clothing.TIGHT),
        ),
        pictures=options.page,
    )
    scored: list[Scored] = []
    names = [case.name for case in chosen] + foreign
    for pair in score_all(names, run, jobs=options.jobs):
        lines = case_lines(pair)
        print("\n".join(lines[1:] if scored else lines), flush=True)
        scored += pair
    for title, part in _parts(scored):
        print(f"\n{title}: {_counts(part)}")
        for lines in (summary_lines, trunk_lines, distance_lines, bmi_lines, worst_lines):
            print("\n".join(lines(part)))
    if options.page is not None:
        print(f"\n{write_page(options.page, scored)}")
    return 0


def _is_chosen(case: Case, options: argparse.Namespace) -> bool:
    if options.case:
        return case.name in options.case
    return options.set in (None, case.series.value) and options.half in (
        None,
        PEOPLE[case.person].half.value,
    )


def _foreign(options: argparse.Namespace) -> list[str]:
    """The foreign pictures that are chosen, in a folder that may not be there."""
    half = None if options.half is None else Half(options.half)
    wanted = options.set in (None, Series.FOREIGN.value) or options.detector or options.chain
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
        (f"foreign, {half.value} half", [each for each in of[Series.FOREIGN] if each.half is half])
        for half in Half
    ]
    if len({each.half for each in of[Series.FOREIGN]}) > 1:
        parts.append(("foreign set", of[Series.FOREIGN]))
    return [(title, part) for title, part in parts if part]


def _halves(cases: Sequence[Case]) -> list[tuple[str, list[Case]]]:
    parts = [
        (f"{half.value} half", [case for case in cases if PEOPLE[case.person].half is half])
        for half in Half
    ]
    return [(title, part) for title, part in parts if part]


def _counts(scored: Sequence[Scored]) -> str:
    people = len({each.person for each in scored})
    return f"people {people}, pictures {len(scored) // len(Cues)}"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.evaluation", description=__doc__)
    parser.add_argument(
        "--half",
        choices=[half.value for half in Half],
        help="choose constants on tuning, report figures on reporting (default: both)",
    )
    parser.add_argument("--set", choices=[series.value for series in Series], help="default: all")
    parser.add_argument(
        "--case",
        action="append",
        choices=[*CASES, *foreign_names()],
        help="these alone (default: all)",
    )
    parser.add_argument("--jobs", type=int, default=1, help="fits made side by side")
    parser.add_argument(
        "--page", type=Path, metavar="DIR", help="write an HTML page with pictures of every fit"
    )
    parser.add_argument(
        "--true-mask",
        action="store_true",
        help="give the person's true mask: what the errors would be without segmentation",
    )
    parser.add_argument(
        "--outline",
        choices=[kind.value for kind in OutlineKind],
        help="what the contour is to meet (default: as every fit)",
    )
    parser.add_argument(
        "--clothing",
        choices=[each.value for each in Clothing],
        help="how clothes are said to lie (default: tight; of the clothed set both, side by side)",
    )
    parser.add_argument(
        "--true-light", action="store_true", help="begin the search for the light at the truth"
    )
    parser.add_argument(
        "--known-focal",
        action="store_true",
        help="give the focal length in pixels, where it is in the file or missing too",
    )
    parser.add_argument(
        "--true-pose",
        action="store_true",
        help="hold the pose at the truth, within half a degree a joint",
    )
    parser.add_argument(
        "--true-place",
        action="store_true",
        help="hold the root joint at the truth too; say --known-focal with it",
    )
    parser.add_argument(
        "--given",
        action="append",
        choices=[key for _, key, _ in MEASUREMENTS],
        help="give this measurement, as a caller of the service may; may be repeated",
    )
    parser.add_argument(
        "--shape-limit",
        action="store_true",
        help="fit nothing: print what the shape space's own coarseness costs",
    )
    parser.add_argument(
        "--outline-limit",
        action="store_true",
        help="fit nothing: print how well exactly known outlines foretell measurements",
    )
    parser.add_argument(
        "--several",
        action="store_true",
        help="combine one, two and three pictures of each person: how measurements tighten",
    )
    parser.add_argument(
        "--surroundings",
        action="store_true",
        help="fit with uniform ambient light and with spherical harmonics, side by side",
    )
    parser.add_argument(
        "--chain",
        action="store_true",
        help="from a body fitted to the true mesh to a fit that is told nothing, foreign pictures",
    )
    parser.add_argument(
        "--moved-points",
        action="store_true",
        help="fit with the points 2 cm away from where they were, in several ways",
    )
    parser.add_argument(
        "--detector",
        action="store_true",
        help="fit with none, each and all of what the detector tells, foreign pictures too",
    )
    parser.add_argument(
        "--checks",
        action="store_true",
        help="fit nothing: how often the checks of a capture find what is wrong, and what is not",
    )
    parser.add_argument(
        "--nonsense",
        action="store_true",
        help="fit people and what is none: how many of each the verdicts contradict",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
