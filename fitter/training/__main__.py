"""``python -m fitter.training``: rebuild the body models, or report on them."""

import argparse
import json
import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import FitterError
from fitter.training.articulation.rigged_bodies import rigged_bodies
from fitter.training.assemble import SHAPE_COUNT
from fitter.training.build import (
    GENDERS,
    Materials,
    Plan,
    read_materials,
    solved_population,
    train_model,
    write_model,
)
from fitter.training.own_bodies.command import train_on_meshes, write_starting_folder
from fitter.training.people.population import PACKAGED_PEOPLE
from fitter.training.report.header_figures import unexplained_measurements
from fitter.training.report.held_out_figures import held_out_figures
from fitter.training.report.sections import Reported, report_lines

HELD_OUT = 200
"""Subjects of the packaged models never trained on."""


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.command == "template" and options.meshes is None:
        parser.error("template needs --meshes FOLDER, the folder to write")
    if options.command == "report" and options.meshes is not None:
        parser.error("report is on the packaged models; build reports on your own")
    try:
        for line in _lines(options):
            print(line, flush=True)
    except (FitterError, ModuleNotFoundError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


def _lines(options: argparse.Namespace) -> Iterator[str]:
    """Do what the command says; what there is to report, line by line."""
    if options.command == "template":
        yield from write_starting_folder(options.meshes, options.gender)
    elif options.meshes is not None:
        yield from train_on_meshes(
            options.meshes,
            options.gender,
            options.output,
            axes=options.axes,
            held_out=options.held_out,
            seed=options.seed,
        )
    else:
        materials = read_materials()
        for gender in GENDERS if options.gender == "both" else (options.gender,):
            path = options.output / f"{gender}.npz"
            if options.command == "build":
                yield from _build(materials[gender], path, options)
            yield from _report(materials[gender], path, options)


def _build(materials: Materials, path: Path, options: argparse.Namespace) -> Iterator[str]:
    plan = Plan(
        subjects=options.subjects,
        held_out=HELD_OUT if options.held_out is None else options.held_out,
        examples=options.examples,
        seed=options.seed,
    )
    count = plan.held_out + plan.subjects
    yield f"{materials.gender}: {count} subjects, about a second each where none are kept"
    population = solved_population(
        materials,
        count=count,
        seed=plan.seed,
        folder=options.people,
        processes=options.processes,
        anew=options.solve,
    )
    yield f"{materials.gender}: training on {plan.subjects} of them"
    write_model(path, train_model(materials, population, plan))


def _report(materials: Materials, path: Path, options: argparse.Namespace) -> Iterator[str]:
    model = load_body_model(path)
    population = solved_population(
        materials,
        count=int(str(model.header["held_out_subjects"])),
        seed=int(str(model.header["seed"])),
        folder=options.people,
        processes=options.processes,
    )
    bodies = rigged_bodies(materials.mesh, population.source_vertices)
    figures = held_out_figures(model, bodies)
    size = path.stat().st_size
    yield from report_lines(Reported(model=model, held_out=figures, file_bytes=size))
    if options.unexplained is not None:
        # Added to a file of such figures, by checksums.
        kept: Path = options.unexplained
        known = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
        known[model.checksum] = unexplained_measurements(model, bodies.rest)
        kept.write_text(json.dumps(known, indent=2, sort_keys=True) + "\n", encoding="utf-8")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m fitter.training",
        description="Train the body models: from MakeHuman's CC0 data and ANSUR II's and NHANES' "
        "statistics, or from registered meshes of your own (OWN_BODIES.md).",
    )
    parser.add_argument(
        "command",
        nargs="?",
        choices=("build", "report", "template"),
        default="build",
        help="build (and report), report on the files that are there, or write a folder to put "
        "meshes of your own into",
    )
    parser.add_argument("--gender", choices=(*GENDERS, "both"), default="both")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--held-out",
        type=int,
        default=None,
        help=f"subjects never trained on; {HELD_OUT}, or a tenth of your own",
    )
    parser.add_argument(
        "--output",
        type=Path,
        default=packaged_model_path("female").parent,
        help="folder of the model files",
    )
    own = parser.add_argument_group("your own bodies")
    own.add_argument(
        "--meshes", type=Path, default=None, help="folder of registered meshes of one gender"
    )
    own.add_argument(
        "--axes", type=int, default=SHAPE_COUNT, help="shape axes, if the bodies span as many"
    )
    packaged = parser.add_argument_group("the packaged models, without --meshes")
    packaged.add_argument("--subjects", type=int, default=1100, help="training subjects a gender")
    packaged.add_argument("--examples", type=int, default=3000, help="posed bodies a gender")
    packaged.add_argument(
        "--processes",
        type=int,
        default=os.cpu_count() or 1,
        help="subjects solved side by side; as many as there are processors by default",
    )
    packaged.add_argument(
        "--people",
        type=Path,
        default=PACKAGED_PEOPLE,
        help="folder that keeps solved subjects, by gender and seed; the package's by default",
    )
    packaged.add_argument(
        "--solve", action="store_true", help="solve anew for subjects that the folder keeps"
    )
    packaged.add_argument(
        "--unexplained",
        type=Path,
        default=None,
        help="file to add to how much held-out bodies differ from their nearest, by measurement",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
