"""Table 1 in the paper's columns, signs and order, and the subject that it is made of."""

import numpy as np
import pytest

from fitter.fits.equipment import prepared_model
from fitter.observation.decoding import decode_picture
from fitter.render.camera import Camera
from fitter.render.rasterizer import render
from fitter.reproduction.drawing import (
    COLUMNS,
    PRINTED_TABLE,
    table_cells,
    table_markdown,
)
from service.commands.paper import packaged_pictures
from service.settings import Settings
from tests.accuracy.cases import CASES
from tests.accuracy.files import PICTURES_FOLDER, read_case
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.scene import Half
from tests.accuracy.subject import PERSON, write_subject


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
