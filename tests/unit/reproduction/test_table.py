"""Table 1 in the paper's columns, signs and order, and the subject that it is made of."""

import csv
import io

import numpy as np
import pytest

from fitter.fits.prepared_model import prepared_model
from fitter.observation.decoding import decode_picture
from fitter.render.camera import Camera
from fitter.render.rasterizer import render
from fitter.reproduction.drawing import (
    PRINTED_TABLE,
    Reproduction,
    index_html,
    table_cells,
    table_csv,
)
from fitter.reproduction.subject import COLUMNS
from service.commands.paper import packaged_pictures
from service.demo_data.sample import load_subject
from service.settings import Settings
from tests.evaluation.cases import CASES
from tests.evaluation.files import PICTURES_FOLDER, read_case
from tests.evaluation.people_table import PEOPLE
from tests.evaluation.scene import Half
from tests.evaluation.subject import PERSON, write_subject


def test_cells_are_those_that_the_paper_prints():
    assert table_cells(PRINTED_TABLE.rows[0])[:3] == ["95.7 (+3.1)", "92.7 (+0.1)", "92.6"]
    assert table_cells(PRINTED_TABLE.rows[1])[6:] == ["62.5 (-0.7)", "62.4 (-0.8)", "63.2"]


def test_no_deviation_has_no_minus_sign():
    assert table_cells(((71.38, 71.42, 71.4),))[:2] == ["71.4 (+0.0)", "71.4 (+0.0)"]


def test_the_table_is_a_line_for_each_pose():
    lines = list(csv.DictReader(io.StringIO(table_csv([PRINTED_TABLE]))))
    assert [each["pose"] for each in lines] == ["1", "2", "3"]
    assert [lines[2][f"{title} GT"] for title, _ in COLUMNS] == ["91.4", "80.3", "62.6"]


def test_the_page_shows_every_table_with_its_heads():
    page = index_html(Reproduction(figures=(), tables=(PRINTED_TABLE,)))
    assert page.count("<table>") == 2
    assert all(title in page for title, _ in COLUMNS)


def test_the_subject_is_one_on_whom_nothing_was_chosen(tmp_path):
    assert PEOPLE[PERSON].half is Half.REPORTING
    write_subject(tmp_path)
    packaged, anew = load_subject(), load_subject(tmp_path)
    assert {name: each.image for name, each in packaged.pictures.items()} == {
        name: (PICTURES_FOLDER / f"{PERSON}_{name}.jpg").read_bytes() for name in anew.pictures
    }
    assert packaged.measurements == pytest.approx(dict(anew.measurements), abs=1e-6)


@pytest.mark.parametrize("number", range(3))
def test_the_true_bodies_are_those_that_the_pictures_show(number: int):
    picture = packaged_pictures(Settings()).subject.pictures[number]
    (view,) = picture.request.views
    files = read_case(CASES[f"{PERSON}_{picture.name}"])
    height, width = decode_picture(view.image, field="image", max_pixels=10**7).pixels.shape[:2]

    camera = Camera(
        focal_length_px=files.scene["focal_length_px"],
        centre_x=width / 2,
        centre_y=height / 2,
        width=width,
        height=height,
    )
    triangles = prepared_model(picture.request.person.gender).operators.model.triangles
    shown = render(picture.posed, triangles, camera).silhouette
    both, either = shown & files.body_mask, shown | files.body_mask
    assert np.count_nonzero(both) / np.count_nonzero(either) > 0.98
