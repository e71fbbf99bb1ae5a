"""The report draws the tapes that the fit laid, with the numbers of its table."""

import base64
import json
import re
import zlib

import numpy as np
import pytest

from api_schemas.results import FitResult
from fitter.export.tapes import tapes_of
from fitter.fits.prepared_model import prepared_model
from fitter.person.fitted_person import FittedPerson
from fitter.vocabulary.measurements import CHIEF
from service.jobs.inputs import PERSON, RESULT, TAPES
from service.worker.derived.report.tape_drawing import TapeDrawing, tape_drawing
from tests.unit.service.derivation_samples import INPUTS, derived
from tests.unit.service.fit_results import fit_result, measurement
from tests.unit.service.test_report import Elements, pages


@pytest.fixture(scope="module")
def tapes() -> bytes:
    person = FittedPerson.from_bytes(INPUTS[PERSON])
    measuring = prepared_model(person.gender).measuring
    shape = person.body.shape
    return tapes_of(measuring.canonical.at(shape), shape, measuring)


@pytest.fixture(scope="module")
def drawing(tapes: bytes) -> TapeDrawing:
    found = tape_drawing(INPUTS | {TAPES: tapes}, models=None)
    assert found is not None
    return found


def chief_result() -> FitResult:
    """With all chief measurements, in the order in which tapes are listed."""
    return fit_result(measurements=[measurement(name) for name in CHIEF])


def test_every_chief_tape_has_one_number_which_lies_on_it(tapes: bytes, drawing: TapeDrawing):
    listed = [name for name in json.loads(tapes)["lines"] if name in CHIEF and name != "stature"]
    assert list(drawing.numbers) == listed
    assert list(drawing.numbers.values()) == list(range(1, len(listed) + 1))
    tags = [tag for panel in drawing.panels for tag in panel.tags]
    assert sorted(tag.number for tag in tags) == list(drawing.numbers.values())
    names = {number: name for name, number in drawing.numbers.items()}
    for panel in drawing.panels:
        for tag in panel.tags:
            line = np.concatenate(panel.view.lines[names[tag.number]])
            # Of a straight line the ends alone are there.
            nearest = np.linalg.norm(line - [tag.x, tag.y], axis=1).min()
            assert nearest < 1.0 or len(line) < 10


def test_numbers_keep_off_each_other(drawing: TapeDrawing):
    for panel in drawing.panels:
        at = np.array([(tag.x, tag.y) for tag in panel.tags])
        apart = np.linalg.norm(at[:, None] - at, axis=2) + np.diag(np.full(len(at), np.inf))
        assert apart.min() > 20.0


def test_waist_and_back_length_are_drawn_where_they_are_seen(drawing: TapeDrawing):
    sides = {tag.number: panel.view.side for panel in drawing.panels for tag in panel.tags}
    assert sides[drawing.numbers["waist_girth_navel"]] == "front"
    assert sides[drawing.numbers["back_waist_length"]] == "back"


def test_page_and_pdf_have_the_drawing_as_lines_and_the_table_its_numbers(
    tapes: bytes, drawing: TapeDrawing
):
    files = {TAPES: tapes, RESULT: chief_result().model_dump_json().encode()}
    output = derived(kind="report", files=files).artifacts
    elements = Elements(output["report.html"])
    paths = [attributes for tag, attributes in elements.found if tag == "path"]
    # The first page shows one of them too.
    assert len(paths) == 2 * (len(drawing.panels) + 1)
    tags = sum(len(each.tags) for each in (*drawing.panels, drawing.panels[0]))
    assert len([tag for tag, _ in elements.found if tag == "circle"]) == tags
    row = r'<td class="no">(\d+)</td><th scope="row">Waist, at the navel</th>'
    (number,) = re.findall(row, output["report.html"].decode())
    assert int(number) == drawing.numbers["waist_girth_navel"]
    assert not re.search(rb"url\(|@import|https?:", output["report.html"])
    assert pages(output["report.pdf"]) == 2
    curves = sum(content.count(b" l ") for content in streams(output["report.pdf"]))
    assert curves > 500


def test_measurements_without_tapes_or_withheld_ones_have_no_drawing(tapes: bytes):
    assert tape_drawing(INPUTS, models=None) is None
    nobody = fit_result(measurements=[], verdict="no_person", outcome="poor_fit")
    withheld = {TAPES: tapes, RESULT: nobody.model_dump_json().encode()}
    output = derived(kind="report", files=withheld).artifacts
    assert b"<svg" not in output["report.html"]
    assert pages(output["report.pdf"]) == 1


def streams(pdf: bytes) -> list[bytes]:
    """What pages are drawn by: reportlab packs it in 85 characters."""
    packed = re.findall(
        rb"ASCII85Decode /FlateDecode \].*?stream\r?\n(.*?)endstream", pdf, re.DOTALL
    )
    return [zlib.decompress(base64.a85decode(each.strip().removesuffix(b"~>"))) for each in packed]
