"""The training commands: a packaged model from a few people, and models of bodies of one's own."""

import functools
import os
import shlex
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from fitter.body.model import BodyModel, regress
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices, shape_for_height, stature_m
from fitter.body.storage import load_body_model
from fitter.fits.equipment import prepared_model
from fitter.fits.initial_body import initial_body
from fitter.parameters import BodyParameters
from fitter.request import Click, Person, View
from fitter.training import build
from fitter.training.__main__ import main
from fitter.training.articulation import bone_centres as inner_points
from fitter.training.own_bodies.command import GUIDE
from fitter.training.own_bodies.learning import OwnPlan, split_subjects
from fitter.training.own_bodies.template import TEMPLATE_FILE
from fitter.training.report import held_out_figures, sections
from fitter.training.shapes.principal_shapes import project, vertex_masses
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.points import POINT_NAMES
from tests.unit.training.makehuman_data import needs_makehuman
from tests.unit.training.own_bodies_folder import (
    DECLARED,
    packaged,
    random_shapes,
    write_bodies,
    write_scans,
)

pytestmark = pytest.mark.slow

SUBJECTS, HELD_OUT, SPANNED = 25, 2, 6
SHAPES = random_shapes(SUBJECTS, axes=SPANNED)


def run(command: str, meshes: Path, models: Path, *more: str) -> int:
    common = ["--gender", "female", "--meshes", str(meshes), "--output", str(models)]
    return main([command, *common, *more])


def documented(command: str) -> list[str]:
    """The arguments that OWN_BODIES.md gives for a command."""
    lines = GUIDE.read_text(encoding="utf-8").splitlines()
    (line,) = (line for line in lines if f"-m fitter.training {command}" in line)
    return shlex.split(line.partition("-m fitter.training ")[2])


@pytest.fixture(scope="module")
def place(tmp_path_factory) -> Iterator[Path]:
    """A working directory in which OWN_BODIES.md is followed."""
    folder = tmp_path_factory.mktemp("own")
    before = Path.cwd()
    os.chdir(folder)
    yield folder
    os.chdir(before)


@pytest.fixture(scope="module")
def meshes(place) -> Path:
    """The folder that the template command writes, with 25 bodies at rest and scans of six."""
    assert main(documented("template")) == 0
    folder = place / "my-bodies"
    write_bodies(folder, SHAPES)
    plan = OwnPlan(axes=SPANNED, held_out=HELD_OUT, seed=1)
    training, held_out = split_subjects(SUBJECTS, plan)
    write_scans(folder, SHAPES, [*training[:4].tolist(), *held_out.tolist()])
    return folder


@pytest.fixture(scope="module")
def models(meshes) -> Path:
    assert main(documented("build")) == 0
    return meshes.parent / "my-models"


@pytest.fixture(scope="module")
def model(models) -> BodyModel:
    return load_body_model(models / "female.npz", gender="female")


def test_the_model_spans_the_bodies_it_was_learned_from_and_those_held_out(model):
    assert len(model.shape_basis) == SPANNED
    errors = model.header["held_out_errors"]
    assert errors["subjects"] == 2
    assert errors["shape_mm"] < 0.01
    assert errors["height_change_at_3_deviations_mm"] < 1.0
    masses = vertex_masses(model.mean_vertices, model.triangles)
    body = rest_vertices(packaged(), 0.5 * random_shapes(1, axes=SPANNED, seed=9)[0])
    _, left = project(body[None], masses, model.mean_vertices, model.shape_basis)
    assert 1000.0 * np.linalg.norm(left, axis=2).max() < 0.1


def test_scans_in_poses_tell_which_pose_dependent_term_is_better(model):
    """These bodies were posed by the packaged term: nothing that four scans teach comes near it."""
    assert "taken over from the packaged female model" in model.header["pose_term"]
    errors = model.header["held_out_errors"]
    assert errors["scans"] == 2
    assert errors["posed_mm"] < 0.2 * errors["posed_rigid_parts_only_mm"]


def test_the_header_says_what_the_user_said(model):
    assert any(DECLARED["source"] in text for text in model.header["sources"])
    assert any(DECLARED["licence"] in text for text in model.header["licences"])
    assert model.header["training_subjects"] == SUBJECTS - 2


def test_clicks_on_a_person_give_their_body_in_the_users_own_model(models):
    """The whole way of a fit before it looks at pixels: pose, limbs, distance, height."""
    body = prepared_model(Gender.FEMALE, models=models)
    model, evaluator = body.operators.model, body.operators.evaluator
    truth = BodyParameters(
        pose=model.canonical_pose,
        translation=np.array([0.0, 0.0, 2.6]),
        shape=shape_for_height(evaluator, 1.7),
    )
    joints = regress(model.landmarks, evaluator.vertices(truth))
    pixels = 900.0 * joints[:, :2] / joints[:, 2:] + [360.0, 480.0]
    places = dict(zip(model.landmarks.names, pixels.tolist(), strict=True))
    view = View(
        image=b"",
        clicks={name: Click(x=places[name][0], y=places[name][1]) for name in POINT_NAMES},
        focal_length_px=900.0,
    )
    person = Person(gender=Gender.FEMALE, height_m=1.7)
    found = initial_body(person, view, body, width=720, height=960)
    placed = regress(model.landmarks, evaluator.vertices(found.body))
    assert np.linalg.norm(placed - joints, axis=1).mean() < 0.1
    standing = BodyParameters(
        pose=model.standing_pose, translation=np.zeros(3), shape=found.body.shape
    )
    height = stature_m(evaluator.body_frame_vertices(standing), model.landmarks)
    assert height == pytest.approx(1.7, abs=1e-3)


def renumbered(folder: Path, order: np.ndarray) -> None:
    """Give a folder and its template the vertices in another order, as another topology."""
    for path in (folder / "rest").glob("*.npy"):
        np.save(path, np.load(path)[order])
    with np.load(folder / TEMPLATE_FILE) as archive:
        arrays = dict(archive)
    for name in ("vertices", "skinning_weights"):
        arrays[name] = arrays[name][order]
    for name in ("joints", "landmarks"):
        arrays[name] = arrays[name][:, order]
    arrays["triangles"] = np.argsort(order)[arrays["triangles"]]
    np.savez(folder / TEMPLATE_FILE, **arrays)


def test_a_topology_of_ones_own_needs_nothing_of_the_packaged_surface(tmp_path, capsys):
    own, models = tmp_path / "meshes", tmp_path / "models"
    assert main(["template", "--meshes", str(own), "--gender", "female"]) == 0
    write_bodies(own, SHAPES[:8])
    renumbered(own, np.random.default_rng(3).permutation(len(packaged().mean_vertices)))
    assert run("build", own, models, "--axes", "4", "--held-out", "1") == 0
    assert "parts turn rigidly" in capsys.readouterr().out
    model = load_body_model(models / "female.npz")
    assert not model.pose_right_hand_sides.any()
    assert not any("packaged" in text for text in model.header["sources"])
    body = prepared_model(Gender.FEMALE, models=models).operators.evaluator
    assert isinstance(body, ScapeEvaluator)


def test_faults_are_said_in_one_line_without_a_trace(tmp_path, capsys):
    assert run("build", tmp_path, tmp_path / "models") == 1
    assert capsys.readouterr().err.startswith("bodies.json cannot be read")
    assert main(["build", "--gender", "female", "--meshes", str(tmp_path)]) == 1
    assert "the packaged models, which stay as they are" in capsys.readouterr().err
    assert main(["build", "--meshes", str(tmp_path), "--output", str(tmp_path / "models")]) == 1
    assert "--gender is both" in capsys.readouterr().err
    for command in (["template"], ["report", "--meshes", str(tmp_path)]):
        with pytest.raises(SystemExit):
            main(command)
    (tmp_path / "notes.txt").write_text("here")
    assert main(["template", "--gender", "male", "--meshes", str(tmp_path)]) == 1
    assert "no empty folder" in capsys.readouterr().err


@pytest.fixture
def _few_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every stage and section is there, of fewer random people and poses than make good figures."""
    monkeypatch.setattr(inner_points, "EXAMPLES", 60)
    few = functools.partial(build.with_volume_learned, samples=40)
    monkeypatch.setattr(build, "with_volume_learned", few)
    monkeypatch.setattr(held_out_figures, "POSED_EXAMPLES", 8)
    few = functools.partial(sections.drawn_measurements, count=200)
    monkeypatch.setattr(sections, "drawn_measurements", few)


@needs_makehuman
@pytest.mark.usefixtures("_few_are_drawn")
def test_a_model_is_built_and_reported_on_from_its_file(tmp_path, capsys):
    counts = ["--subjects", "24", "--held-out", "2", "--examples", "12"]
    told = ["--unexplained", str(tmp_path / "unexplained.json")]
    assert main(["build", "--gender", "female", *counts, "--output", str(tmp_path), *told]) == 0
    model = load_body_model(tmp_path / "female.npz")
    assert model.header["training_subjects"] == 24
    assert 1.5 < model.header["height_m"]["mean"] < 1.75
    printed = capsys.readouterr().out
    assert "the header's held-out figures, made again: the same" in printed
    assert "weightkg" in printed
    assert model.checksum in (tmp_path / "unexplained.json").read_text()
