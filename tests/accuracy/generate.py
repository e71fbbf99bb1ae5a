"""``python -m tests.accuracy.generate``: (re)build the suite's pictures and truths.

Needs the renderer and marching cubes: the extra ``evaluation``. Everything is drawn from the cases'
seeds, so that a second run gives the same pictures, to the rounding of light added up by several
threads.
``--documents`` writes requests and truths alone, after a change of landmarks or measurement
definitions, and needs no renderer.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from tests.accuracy.cases import CASES, DEMO, PEOPLE
from tests.accuracy.files import (
    PICTURES_FOLDER,
    document,
    write_document,
    write_picture,
)
from tests.accuracy.people import load_person
from tests.accuracy.scene import Case, Series
from tests.accuracy.staging import Staged, stage

SAMPLES = {
    Series.SAMPLE: 64,
    Series.PEOPLE: 36,
    Series.LIGHTS: 36,
    Series.CLOTHED: 25,
    Series.PHONE: 36,
    Series.CLOTHED_PAIRS: 25,
}
QUALITY = {
    Series.SAMPLE: 92,
    Series.PEOPLE: 86,
    Series.LIGHTS: 86,
    Series.CLOTHED: 86,
    Series.PHONE: 86,
    Series.CLOTHED_PAIRS: 86,
}
SAMPLE_FOLDER = Path(__file__).parents[2] / "service" / "demo_data"


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    for name in options.case or list(CASES):
        staged = _staged(CASES[name])
        write_document(options.output, staged)
        if not options.documents:
            _render(staged, options)
        if CASES[name] is DEMO and options.output == PICTURES_FOLDER:
            _write_sample(staged, options.output)
        print(f"{name}: written to {options.output}", flush=True)
    return 0


def _render(staged: Staged, options: argparse.Namespace) -> None:
    from tests.accuracy.render_mitsuba import linear_picture_and_labels

    case = staged.case
    linear, labels = linear_picture_and_labels(
        staged, samples=options.samples or SAMPLES[case.series]
    )
    write_picture(options.output, staged, linear, labels, quality=QUALITY[case.series])


def _staged(case: Case) -> Staged:
    return stage(load_person(PEOPLE[case.person]), case)


def _write_sample(staged: Staged, folder: Path) -> None:
    """The sample of ``maquette demo`` is this suite's demo case."""
    SAMPLE_FOLDER.mkdir(exist_ok=True)
    picture = (folder / f"{staged.case.name}.jpg").read_bytes()
    (SAMPLE_FOLDER / "sample.jpg").write_bytes(picture)
    described = document(staged)
    request = dict(described["request"])
    view = {"points": request.pop("points")}
    for name, values in (
        ("request", request | {"views": [view]}),
        ("truth", {"measurements": described["truth"], "credits": described["credits"]}),
    ):
        (SAMPLE_FOLDER / f"{name}.json").write_text(json.dumps(values, indent=1) + "\n")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m tests.accuracy.generate",
        description="Build the pictures and truths of the evaluation suite.",
    )
    parser.add_argument("--case", action="append", choices=list(CASES), help="default: all")
    parser.add_argument("--output", type=Path, default=PICTURES_FOLDER, metavar="DIR")
    parser.add_argument("--samples", type=int, help="light paths a pixel")
    parser.add_argument(
        "--documents", action="store_true", help="requests and truths only, without rendering"
    )
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
