"""``python -m tests.accuracy.generate``: (re)build the suite's pictures and truths.

Needs the renderer: the extra ``evaluation``. ``--cases`` draws another file's
pictures, of the suite's people in other stances, clothes, rooms and light. Noise comes from the
cases' seeds: a second run gives the same pictures, to the rounding of light added up by threads.
``--documents`` writes requests and truths alone, after a change of landmarks or measurement
definitions, and needs no renderer.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from tests.accuracy.cases import CASES_FILE, DEMO, PEOPLE, read_cases
from tests.accuracy.files import (
    PICTURES_FOLDER,
    document,
    write_document,
    write_picture,
)
from tests.accuracy.people import load_person
from tests.accuracy.scene import Series
from tests.accuracy.staging import Staged, stage

SAMPLES = 36
SAMPLES_OF = {Series.SAMPLE: 64, Series.CLOTHED: 25, Series.CLOTHED_PAIRS: 25}
"""Light paths a pixel, of most pictures and of sets."""

QUALITY, BEST_QUALITY = 86, 92
"""Of JPEG files; the sample's is the better one."""

SAMPLE_FOLDER = Path(__file__).parents[2] / "service" / "demo_data"


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    cases = read_cases(options.cases)
    for name in options.case or list(cases):
        staged = stage(load_person(PEOPLE[cases[name].person]), cases[name])
        write_document(options.output, staged)
        if not options.documents:
            _render(staged, options)
        if name == DEMO.name and options.output == PICTURES_FOLDER:
            _write_sample(staged, options.output)
        print(f"{name}: written to {options.output}", flush=True)
    return 0


def _render(staged: Staged, options: argparse.Namespace) -> None:
    from tests.accuracy.render_mitsuba import linear_picture_and_labels

    case = staged.case
    samples = options.samples or SAMPLES_OF.get(case.series, SAMPLES)
    linear, labels = linear_picture_and_labels(staged, samples=samples)
    quality = BEST_QUALITY if case.series is Series.SAMPLE else QUALITY
    write_picture(options.output, staged, linear, labels, quality=quality)


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
    parser.add_argument(
        "--cases",
        type=Path,
        default=CASES_FILE,
        metavar="FILE",
        help="as the suite's data/cases.json",
    )
    parser.add_argument("--case", action="append", metavar="NAME", help="default: all of the file")
    parser.add_argument("--output", type=Path, default=PICTURES_FOLDER, metavar="DIR")
    parser.add_argument("--samples", type=int, help="light paths a pixel")
    parser.add_argument(
        "--documents", action="store_true", help="requests and truths only, without rendering"
    )
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
