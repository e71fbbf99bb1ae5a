"""The command line of own bodies: template, build and report with ``--meshes FOLDER``."""

from collections.abc import Iterator
from pathlib import Path

from fitter.body.model import BodyModel
from fitter.body.model_checks import GENDERS
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import MeshFolderError
from fitter.training.build import write_model
from fitter.training.own_bodies.figures import own_errors, own_report_lines
from fitter.training.own_bodies.folder import read_own_bodies
from fitter.training.own_bodies.learning import (
    OwnPlan,
    split_subjects,
    train_own_model,
    with_poses,
)
from fitter.training.own_bodies.template import packaged_template
from fitter.training.own_bodies.template_files import write_starting_folder

GUIDE = Path(__file__).with_name("OWN_BODIES.md")
"""What a user reads; installed with the package."""

HELD_OUT_SHARE = 0.1
"""Of a user's subjects, unless the number is given."""


def write_template(meshes: Path, gender: str) -> Iterator[str]:
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
    write_starting_folder(meshes, packaged_template(packaged))
    size = f"{len(packaged.mean_vertices)} vertices, {len(packaged.triangles)} triangles"
    yield f"{meshes}: template.obj has {size}"
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
    """Measure a model again on the subjects of its folder that were held out.

    Raises
    ------
    MeshFolderError
        If the folder is not the one that the model was trained on.
    ModelFileError
        If there is no such model, or it cannot be read.
    """
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
    _, held_out = split_subjects(len(bodies.subjects), _plan_of(model))
    errors = own_errors(model, bodies.rest, held_out, with_poses(bodies, packaged))
    yield from own_report_lines(model, errors, file_bytes=path.stat().st_size)


def _packaged(gender: str, output: Path | None = None) -> BodyModel:
    """The packaged model of the gender, once it is sure that ``output`` would not replace it."""
    if gender not in GENDERS:
        raise MeshFolderError(
            place="--gender",
            reason=f"is {gender}: a folder holds bodies of one",
            remedy="Write --gender female or --gender male.",
        )
    packaged = packaged_model_path(gender)
    if output is not None and output.resolve() == packaged.parent.resolve():
        raise MeshFolderError(
            place="--output",
            reason="is the folder of the packaged models, which stay as they are",
            remedy="Name another folder; fits use it with --models or MAQUETTE_MODELS_DIR.",
        )
    return load_body_model(packaged, gender=gender)


def _plan_of(model: BodyModel) -> OwnPlan:
    header = model.header
    return OwnPlan(
        axes=len(model.shape_basis),
        held_out=int(str(header["held_out_subjects"])),
        seed=int(str(header["seed"])),
    )
