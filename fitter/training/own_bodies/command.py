"""The command line of own bodies: template and build with ``--meshes FOLDER``."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path

from fitter.body.model import BodyModel
from fitter.body.model_checks import GENDERS
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import MeshFolderError
from fitter.training.build import write_model
from fitter.training.own_bodies.folder import (
    BODIES_FILE,
    POSED_FOLDER,
    REST_FOLDER,
    read_own_bodies,
)
from fitter.training.own_bodies.learning import OwnPlan, train_own_model
from fitter.training.own_bodies.mesh_files import write_obj
from fitter.training.own_bodies.template import TEMPLATE_FILE, packaged_template, write_template

GUIDE = Path(__file__).with_name("OWN_BODIES.md")
"""Guide for users; installed with the package."""

HELD_OUT_SHARE = 0.1
"""Share of a user's subjects that is held out, unless the number is given."""


def write_starting_folder(meshes: Path, gender: str) -> Iterator[str]:
    """Write a folder to start from: the packaged topology, its anatomy and mean body.

    Raises
    ------
    MeshFolderError
        If the gender is not one, or the folder holds anything.
    """
    packaged = _packaged(gender)
    if meshes.exists() and not (meshes.is_dir() and not any(meshes.iterdir())):
        raise MeshFolderError(
            place=str(meshes),
            reason="is there already, and no empty folder",
            remedy="Name a folder that is not there yet.",
        )
    for name in (REST_FOLDER, POSED_FOLDER):
        (meshes / name).mkdir(parents=True)
    write_obj(meshes / "template.obj", packaged.mean_vertices, packaged.triangles)
    write_template(meshes / TEMPLATE_FILE, packaged_template(packaged))
    unsaid = json.dumps({"source": "", "licence": ""})
    (meshes / BODIES_FILE).write_text(f"{unsaid}\n", encoding="utf-8")
    yield f"{meshes}: template.obj has {_size(packaged)}"
    yield f"Put one registered mesh a subject into rest/ and fill in bodies.json; see {GUIDE}."


def train_on_meshes(
    meshes: Path, gender: str, output: Path, *, axes: int, held_out: int | None, seed: int
) -> Iterator[str]:
    """Train on a folder and write the model; the report line by line.

    ``held_out`` is a number of subjects; None holds out :data:`HELD_OUT_SHARE`.

    Raises
    ------
    MeshFolderError
        For the first fault of the folder, or where the model would replace a packaged one.
    """
    packaged = _packaged(gender)
    if output.resolve() == packaged_model_path(gender).parent.resolve():
        raise MeshFolderError(
            place="--output",
            reason="is the folder of the packaged models, which stay as they are",
            remedy="Name another folder; fits use it with --models or MAQUETTE_MODELS_DIR.",
        )
    bodies = read_own_bodies(meshes, packaged_template(packaged))
    count = len(bodies.subjects)
    yield f"{gender}: {count} bodies at rest, {len(bodies.scans)} in poses; {bodies.template.name}"
    plan = OwnPlan(
        axes=axes,
        held_out=max(1, round(HELD_OUT_SHARE * count)) if held_out is None else held_out,
        seed=seed,
    )
    trained, remarks = train_own_model(bodies, plan, packaged)
    yield from (f"{gender}: {remark}" for remark in remarks)
    path = output / f"{gender}.npz"
    yield from own_report_lines(write_model(path, trained), path.stat().st_size)


def own_report_lines(model: BodyModel, file_bytes: int) -> Iterator[str]:
    """The report, line by line, from the model's header."""
    header = model.header
    figures = header["held_out_errors"]
    assert isinstance(figures, Mapping)
    size = f"{len(model.shape_basis)} shape axes, {file_bytes / 1e6:.1f} MB"
    subjects = f"{header['training_subjects']} subjects, held out {figures['subjects']}"
    yield f"{model.gender}: {_size(model)}, {size}"
    yield f"  trained on {subjects}, seed {header['seed']}"
    yield f"  pose-dependent term: {header['pose_term']}"
    yield from (f"  {name:<38}{value:9.3f}" for name, value in figures.items())


def _packaged(gender: str) -> BodyModel:
    if gender not in GENDERS:
        raise MeshFolderError(
            place="--gender",
            reason=f"is {gender}: a folder holds bodies of one",
            remedy="Write --gender female or --gender male.",
        )
    return load_body_model(packaged_model_path(gender), gender=gender)


def _size(model: BodyModel) -> str:
    return f"{len(model.mean_vertices)} vertices, {len(model.triangles)} triangles"
