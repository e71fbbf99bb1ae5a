"""The command line of own bodies: ``--meshes FOLDER`` and ``template FOLDER``."""

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fitter.body.model import BodyModel
from fitter.body.model_checks import GENDERS
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import MeshFolderError
from fitter.training.assemble import SHAPE_COUNT
from fitter.training.build import write_model
from fitter.training.own_bodies.figures import own_errors, own_report_lines
from fitter.training.own_bodies.folder import OwnBodies, read_own_bodies
from fitter.training.own_bodies.learning import (
    OwnPlan,
    split_subjects,
    train_own_model,
    with_poses,
)
from fitter.training.own_bodies.template import packaged_template
from fitter.training.own_bodies.template_files import write_starting_folder

HELD_OUT_SHARE = 0.1
"""Of a user's subjects, unless the number is given."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command line knows beside the arguments of the packaged models' training."""
    parser.add_argument(
        "folder", nargs="?", type=Path, help="template: the folder to write, for own meshes"
    )
    parser.add_argument(
        "--meshes",
        type=Path,
        default=None,
        help="train on the registered meshes in this folder instead (OWN_BODIES.md)",
    )
    parser.add_argument(
        "--axes", type=int, default=SHAPE_COUNT, help="shape axes learned from own meshes"
    )


def write_template(gender: str, folder: Path | None) -> Iterator[str]:
    """Write a folder to start from: the packaged topology, its anatomy and mean body."""
    if folder is None or gender not in GENDERS:
        raise MeshFolderError(
            place="template",
            reason="needs a folder and a gender",
            remedy="Write `python -m fitter.training template FOLDER --gender female`.",
        )
    if folder.exists() and any(folder.iterdir()):
        raise MeshFolderError(
            place=str(folder), reason="is not empty", remedy="Name a folder that is not there yet."
        )
    model = load_body_model(packaged_model_path(gender), gender=gender)
    write_starting_folder(folder, packaged_template(model))
    yield f"{folder}: {len(model.mean_vertices)} vertices, {len(model.triangles)} triangles"
    yield "Put one registered mesh a subject into rest/ and fill in bodies.json; see OWN_BODIES.md."


def train_on_meshes(
    meshes: Path, gender: str, output: Path, *, axes: int, held_out: int | None, seed: int
) -> Iterator[str]:
    """Train on a folder, write the model, report line by line."""
    packaged = _packaged(gender, output)
    bodies = read_own_bodies(meshes, packaged_template(packaged))
    count = len(bodies.subjects)
    yield f"{gender}: {count} bodies at rest, {len(bodies.posed)} in poses; {bodies.template.name}"
    plan = OwnPlan(
        axes=axes,
        held_out=max(1, round(HELD_OUT_SHARE * count)) if held_out is None else held_out,
        seed=seed,
    )
    trained = train_own_model(bodies, plan, packaged)
    yield from (f"{gender}: {remark}" for remark in trained.remarks)
    path = output / f"{gender}.npz"
    model = write_model(path, trained.model)
    yield from own_report_lines(model, trained.errors, file_bytes=path.stat().st_size)


def report_on_meshes(meshes: Path, gender: str, output: Path) -> Iterator[str]:
    """Measure a model again on the subjects of its folder that were held out."""
    packaged = _packaged(gender, output)
    path = output / f"{gender}.npz"
    model = load_body_model(path, gender=gender)
    bodies = read_own_bodies(meshes, packaged_template(packaged))
    if model.header.get("meshes_sha256") != bodies.sha256:
        raise MeshFolderError(
            place=str(meshes),
            reason=f"holds other files than those {path.name} was trained on",
            remedy="Train again, or report on the folder as it was.",
        )
    errors = own_errors(model, bodies.rest, _held_out(model, bodies), with_poses(bodies))
    yield from own_report_lines(model, errors, file_bytes=path.stat().st_size)


def _packaged(gender: str, output: Path) -> BodyModel:
    if gender not in GENDERS:
        raise MeshFolderError(
            place="--gender",
            reason=f"is {gender}: a folder holds bodies of one",
            remedy="Write --gender female or --gender male.",
        )
    packaged = packaged_model_path(gender)
    if output.resolve() == packaged.parent.resolve():
        raise MeshFolderError(
            place="--output",
            reason="is the folder of the packaged models, which stay as they are",
            remedy="Name another folder; fits use it with --models or MAQUETTE_MODELS_DIR.",
        )
    return load_body_model(packaged, gender=gender)


def _held_out(model: BodyModel, bodies: OwnBodies) -> np.ndarray:
    header = model.header
    plan = OwnPlan(
        axes=len(model.shape_basis),
        held_out=int(str(header["held_out_subjects"])),
        seed=int(str(header["seed"])),
    )
    return split_subjects(len(bodies.subjects), plan)[1]
