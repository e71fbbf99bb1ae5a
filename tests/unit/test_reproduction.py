"""The paper's figures and its Table 1."""

import numpy as np
import pytest

from fitter.fits.equipment import prepared_model
from fitter.observation.decoding import decode_picture
from fitter.parameters import BodyParameters
from fitter.render.camera import Camera
from fitter.render.rasterizer import render
from fitter.reproduction.drawing import (
    COLUMNS,
    PRINTED_TABLE,
    displacements_m,
    table_cells,
    table_markdown,
)
from fitter.reproduction.looks import textured_body
from fitter.reproduction.panels import overlaps, row
from fitter.vocabulary.choices import Gender
from service.commands.paper import packaged_pictures
from service.settings import Settings
from tests.accuracy.cases import CASES
from tests.accuracy.files import PICTURES_FOLDER, read_case
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.scene import Half
from tests.illustrations.subject import PERSON, write_subject

CAMERA = Camera(focal_length_px=900.0, centre_x=200.0, centre_y=260.0, width=400, height=520)


@pytest.fixture(scope="module")
def posed():
    evaluator = prepared_model(Gender.FEMALE).operators.evaluator
    body = BodyParameters(
        pose=evaluator.model.canonical_pose,
        translation=np.array([0.0, 0.0, 3.4]),
        shape=np.zeros(len(evaluator.model.shape_basis)),
    )
    return evaluator.model, evaluator.vertices(body)


def test_overlaps_have_the_papers_colours():
    body = np.array([[True, True, False, False]])
    observed = np.array([[True, False, True, False]])
    both, alone, seen, neither = overlaps(body, observed)[0].astype(int)
    assert min(both[0], both[1]) > both[2]
    assert alone.argmax() == 0
    assert seen.argmax() == 2
    assert neither.tolist() == [255, 255, 255]


def test_panels_of_a_row_have_one_height():
    pictures = [np.zeros((50, 20, 3), np.uint8), np.zeros((10, 30, 3), np.uint8)]
    drawn = row([("one", pictures[0]), ("other", pictures[1])], height_px=100)
    below_the_labels = drawn[30:, :, 0] < 10
    dark = below_the_labels.sum(axis=1)
    assert drawn.shape[0] > 100
    np.testing.assert_allclose(dark, 40 + 300, atol=2)


def test_displacements_do_not_count_where_a_body_stands():
    rng = np.random.default_rng(1)
    body = rng.standard_normal((30, 3))
    np.testing.assert_allclose(displacements_m(body + [3.0, 0.0, 1.0], body), 0.0, atol=1e-12)
    moved = body.copy()
    moved[0] += [0.3, 0.0, 0.0]
    assert displacements_m(moved, body)[0] == pytest.approx(0.3 * 29 / 30)


def test_a_texture_lies_where_the_atlas_says(posed):
    model, vertices = posed
    size = 512
    across = np.tile(np.linspace(0, 255, size), (size, 1))
    texture = np.stack([across, across.T, np.full((size, size), 90.0)], axis=2).astype(np.uint8)
    drawn = textured_body(vertices, model, texture, CAMERA)
    rendering = render(vertices, model.triangles, CAMERA)
    seen = rendering.face_ids >= 0
    rows, columns = np.nonzero(seen)
    # Small triangles have their middle within a pixel or so of every pixel that shows them.
    middle = model.uv[model.uv_triangles[rendering.face_ids[seen]]].mean(axis=1)
    expected = 255.0 * np.stack([middle[:, 0], 1.0 - middle[:, 1]], axis=1)
    off = np.abs(drawn[rows, columns, :2] - expected)
    assert np.median(off) < 2.0
    assert (drawn[~seen] == 255).mean() > 0.98


def test_cells_are_those_that_the_paper_prints():
    assert table_cells(PRINTED_TABLE.rows[0])[:3] == ["95.7 (+3.1)", "92.7 (+0.1)", "92.6"]
    assert table_cells(PRINTED_TABLE.rows[1])[6:] == ["62.5 (-0.7)", "62.4 (-0.8)", "63.2"]


def test_no_deviation_has_no_minus_sign():
    assert table_cells(((71.38, 71.42, 71.4),))[:2] == ["71.4 (+0.0)", "71.4 (+0.0)"]


def test_a_table_has_a_row_for_each_pose():
    _, _, heads, _, *rows = table_markdown(PRINTED_TABLE).splitlines()
    assert all(title in heads for title, _ in COLUMNS)
    assert [row.split(" | ")[0] for row in rows] == ["| Pose 1", "| Pose 2", "| Pose 3"]
    assert {row.count("|") for row in (heads, *rows)} == {11}


@pytest.mark.slow
def test_the_subject_is_one_on_whom_nothing_was_chosen(tmp_path):
    assert PEOPLE[PERSON].half is Half.REPORTING
    write_subject(tmp_path)
    (_, packaged), (_, anew) = (packaged_pictures(Settings(), *each) for each in ((), (tmp_path,)))
    assert {name: each.views[0].image for name, each in packaged.requests.items()} == {
        name: (PICTURES_FOLDER / f"{PERSON}_{name}.jpg").read_bytes() for name in anew.requests
    }
    assert packaged.measurements == pytest.approx(dict(anew.measurements), abs=1e-6)


@pytest.mark.parametrize("pose", packaged_pictures(Settings())[1].requests)
def test_the_true_bodies_are_those_that_the_pictures_show(pose: str):
    _, subject = packaged_pictures(Settings())
    (view,) = subject.requests[pose].views
    files = read_case(CASES[f"{PERSON}_{pose}"])
    height, width = decode_picture(view.image, field="image", max_pixels=10**7).pixels.shape[:2]

    camera = Camera(
        focal_length_px=files.scene["focal_length_px"],
        centre_x=width / 2,
        centre_y=height / 2,
        width=width,
        height=height,
    )
    triangles = prepared_model(subject.requests[pose].person.gender).operators.model.triangles
    shown = render(subject.posed[pose], triangles, camera).silhouette
    both, either = shown & files.body_mask, shown | files.body_mask
    assert np.count_nonzero(both) / np.count_nonzero(either) > 0.98
