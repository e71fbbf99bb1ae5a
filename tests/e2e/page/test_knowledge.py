"""What is known beside the clicks: samples with theirs, a tape, a mask, clothes; in any units."""

import io
import json
import re
from pathlib import Path

import httpx
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

from service.demo_data.sample import FOLDER
from tests.e2e.page.visitor import SAMPLE_SIZE, Visitor
from tests.e2e.service import REPOSITORY

MASK = REPOSITORY / "tests" / "accuracy" / "data" / "pictures" / "demo_person.png"


@pytest.fixture
def mask(tmp_path: Path) -> Path:
    """White on the person, of the sample's size."""
    with Image.open(MASK) as picture:
        grey = picture.convert("L").resize(SAMPLE_SIZE)
    path = tmp_path / "mask.png"
    path.write_bytes(_png(np.where(np.asarray(grey) > 127, 255, 0).astype(np.uint8)))
    return path


def _png(levels: np.ndarray) -> bytes:
    written = io.BytesIO()
    Image.fromarray(levels).save(written, "PNG")
    return written.getvalue()


@pytest.mark.parametrize(
    ("name", "file"),
    [("At ease", "request"), ("Upright", "woman"), ("An arm across", "arm_across")],
)
def test_every_sample_comes_with_its_clicks_and_a_body(visitor: Visitor, name: str, file: str):
    asked = json.loads((FOLDER / f"{file}.json").read_text())
    visitor.open_sample(name=name, with_points=True)
    page = visitor.page
    expect(visitor.points()).to_have_count(len(asked["views"][0]["points"]))
    expect(page.get_by_label("Height", exact=True)).to_have_value(f"{100 * asked['height_m']:g}")
    expect(page.locator(".live-outline")).to_be_attached()
    expect(page.get_by_text("No body reaches")).to_be_hidden()
    expect(page.get_by_role("button", name="Measure", exact=True)).to_be_enabled()


def test_a_tape_and_a_mask_reach_the_fit_and_come_back_with_it(
    visitor: Visitor, service: httpx.Client, mask: Path
):
    page = visitor.page
    visitor.open_sample(with_points=True)
    page.get_by_text("Known measurements").click()
    page.get_by_label("Hip", exact=True).fill("9.8")
    expect(page.get_by_text("Hip: between 10 and 200 cm")).to_be_visible()
    expect(page.get_by_role("button", name="Correct a measurement")).to_be_disabled()
    page.get_by_label("Hip", exact=True).fill("98")
    visitor.correct()
    page.get_by_role("heading", name="Lens, shading and mask").click()
    small = mask.with_name("small.png")
    small.write_bytes(_png(np.zeros((96, 128), np.uint8)))
    page.get_by_label("Choose a mask").set_input_files(small)
    expect(page.get_by_role("alert")).to_contain_text("128 × 96 pixels, the picture 720 × 960")
    page.get_by_label("Choose a mask").set_input_files(mask)
    expect(page.get_by_role("img", name="The border of the mask")).to_be_visible()
    visitor.choose("Jacket on top")
    asked = visitor.sent_request()
    assert asked["measurements"] == {"hip_girth": {"value": 98, "standard_error": 1}}
    (view,) = asked["views"]
    assert view["clothing"] == "outer"
    assert len(view["mask_id"]) == 64
    visitor.wait_for_result()
    job = service.get(f"/v1/fits/{page.url.rpartition('/')[2]}").json()
    # With a mask there is nothing to segment.
    assert "views/0/trimap.png" not in job["links"]["files"]
    result = service.get(job["links"]["result"]).json()
    hip = next(each for each in result["measurements"] if each["name"] == "hip_girth")
    assert abs(hip["value"] - 98.0) < 2.0
    page.get_by_role("button", name="Adjust", exact=True).click()
    page.get_by_text("Known measurements").click()
    expect(page.get_by_label("Hip", exact=True)).to_have_value("98")
    expect(page.get_by_role("img", name="The border of the mask")).to_be_visible()
    page.get_by_role("heading", name="Lens, shading and mask").click()
    expect(page.get_by_text("the mask of that result is used")).to_be_visible()
    expect(page.get_by_role("radio", name="Jacket on top", exact=True)).to_be_checked()


def test_a_fit_in_feet_and_pounds_reaches_its_result(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(with_points=True)
    visitor.choose("ft, lb")
    height, inches = page.get_by_label("Height", exact=True), page.get_by_label("Height, inches")
    expect(height).to_have_value("5")
    expect(inches).to_have_value("11.02")
    visitor.choose("cm, kg")
    expect(height).to_have_value("180.4")
    visitor.choose("ft, lb")
    inches.fill("")
    height.fill("5'11")
    page.get_by_label("Weight", exact=True).fill("170")
    sent = visitor.sent_request()
    assert round(sent["height_m"], 4) == 1.8034
    assert round(sent["weight_kg"], 2) == 77.11
    visitor.wait_for_result()
    visitor.wait_until_drawn(placement="canonical")
    row = page.get_by_role("row", name=re.compile("^Height"))
    expect(row).to_contain_text("5 ft 11.0 in")
    expect(page.get_by_role("row", name=re.compile("^Weight"))).to_contain_text("170.0 lb")
    expect(page.get_by_role("row", name=re.compile("^Hip"))).to_contain_text(" in")
    visitor.choose("cm, kg")
    expect(row).to_contain_text("180.3")
    visitor.choose("in, lb")
    expect(row).to_contain_text("5 ft 11.0 in")
