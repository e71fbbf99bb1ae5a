"""What is known beside the clicks: samples with theirs, a tape, a mask; and SE against SES."""

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
from tests.e2e.page.visitor import SAMPLE_SIZE, VISIBLY, Visitor
from tests.e2e.service import REPOSITORY

MASK = REPOSITORY / "tests" / "evaluation" / "data" / "pictures" / "demo_person.png"


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
    expect(visitor.points()).to_have_count(len(asked["points"]))
    expect(page.get_by_label("Height", exact=True)).to_have_value(f"{100 * asked['height_m']:g}")
    expect(page.locator(".live-outline")).to_be_attached()
    expect(page.get_by_text("No body reaches")).to_be_hidden()
    expect(page.get_by_text("may be swapped")).to_be_hidden()
    expect(page.get_by_role("button", name="Fit the body")).to_be_enabled()


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
    page.get_by_role("heading", name="What the fit goes by").click()
    small = mask.with_name("small.png")
    small.write_bytes(_png(np.zeros((96, 128), np.uint8)))
    page.get_by_label("Choose a mask").set_input_files(small)
    expect(page.get_by_role("alert")).to_contain_text("128 × 96 pixels, the picture 720 × 960")
    page.get_by_label("Choose a mask").set_input_files(mask)
    expect(page.get_by_role("img", name="The border of the mask")).to_be_visible()
    asked = visitor.sent_request()
    assert asked["measurements"] == {"hip_girth": {"value": 98, "standard_error": 1}}
    assert len(asked["mask_id"]) == 64
    visitor.wait_for_result()
    job = service.get(f"/v1/fits/{page.url.rpartition('/')[2]}").json()
    # With a mask there is nothing to segment.
    assert "trimap.png" not in job["links"]["artifacts"]
    result = service.get(job["links"]["result"]).json()
    hip = next(each for each in result["measurements"] if each["name"] == "hip_girth")
    assert abs(hip["value"] - 98.0) < 2.0
    page.get_by_role("button", name="Correct something").click()
    page.get_by_text("Known measurements").click()
    expect(page.get_by_label("Hip", exact=True)).to_have_value("98")
    expect(page.get_by_role("img", name="The border of the mask")).to_be_visible()
    page.get_by_role("heading", name="What the fit goes by").click()
    expect(page.get_by_text("the mask of that fit is used")).to_be_visible()


def test_light_and_clothes_that_were_told_reach_the_fit_and_come_back_with_it(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(with_points=True)
    visitor.correct()
    # With the body come questions, which move what lies below them.
    expect(page.locator(".live-outline")).to_be_attached()
    page.get_by_role("heading", name="Lens and light").click()
    ball = page.get_by_role("slider", name="Direction of the light")
    expect(ball).to_have_attribute("aria-valuetext", "left to the fit")
    ball.scroll_into_view_if_needed()
    box = ball.bounding_box()
    assert box is not None
    before = visitor.pixels(ball)
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.25 * box["width"], box["y"] + 0.25 * box["height"], steps=4)
    page.mouse.up()
    # Half a radius to the left and up: both sines are a half of the light brightest there.
    expect(ball).to_have_attribute("aria-valuetext", re.compile("° from the left, 30° from above"))
    lit = visitor.pixels(ball)
    assert np.abs(lit - before).max() > VISIBLY
    rows, columns = np.ogrid[-1 : 1 : 1j * lit.shape[0], -1 : 1 : 1j * lit.shape[1]]
    levels = np.where(np.hypot(rows, columns) < 0.9, lit.sum(axis=2), 0)
    brightest = np.argwhere(levels >= np.quantile(levels, 0.98)).mean(axis=0)
    assert (brightest < 0.45 * np.array(levels.shape)).all()
    visitor.choose("Sun")
    visitor.choose("By direction")
    page.get_by_role("heading", name="What the fit goes by").click()
    visitor.choose("Loose")
    asked = visitor.sent_request()
    assert asked["clothing"] == "loose"
    assert asked["light"]["surroundings"] == "spherical_harmonics"
    assert asked["light"]["kind"] == "directional"
    assert asked["light"]["azimuth_deg"] == pytest.approx(-35.3, abs=1.5)
    assert asked["light"]["elevation_deg"] == pytest.approx(30.0, abs=1.5)
    visitor.wait_for_result()
    expect(page.get_by_text("Under loose clothes the body is only estimated")).to_be_visible()
    page.get_by_role("heading", name="For experts").click()
    expect(page.get_by_text("from the surroundings, by direction")).to_be_visible()
    visitor.choose("Photo")
    visitor.unfold_for_experts()
    visitor.wait_until_drawn(placement="picture")
    visitor.choose("Lit")
    lit = visitor.wait_until_drawn(placement="picture", surface="lit")
    visitor.choose("Clay")
    clay = visitor.wait_until_drawn(placement="picture")
    # Skin, and as bright as in the picture.
    changed = np.abs(lit - clay).max(axis=2) > VISIBLY
    assert changed.mean() > 0.1
    assert lit[changed].mean() > 40
    page.get_by_role("button", name="Correct something").click()
    page.get_by_role("heading", name="Lens and light").click()
    expect(page.get_by_role("radio", name="By direction")).to_be_checked()
    page.get_by_role("heading", name="What the fit goes by").click()
    expect(page.get_by_role("radio", name="Loose", exact=True)).to_be_checked()


def test_the_body_before_shading_can_be_seen_in_its_place(visitor: Visitor, finished_fit: str):
    page = visitor.page
    # The skin, which stands beside the final body alone, leaves it less room.
    page.route("**/derivations*", lambda route: route.abort())
    page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    visitor.wait_for_result()
    visitor.unfold_for_experts()
    final = visitor.wait_until_drawn(placement="canonical")
    visitor.choose("Outline alone")
    outlined = visitor.wait_until_drawn(placement="canonical", cues="SE")
    assert (np.abs(outlined - final).max(axis=2) > 12).mean() > 0.001
    # Nothing is known of the skin then.
    expect(page.get_by_role("radio", name="Albedo", exact=True)).to_have_count(0)
    visitor.choose("With shading")
    again = visitor.wait_until_drawn(placement="canonical")
    assert (np.abs(again - final).max(axis=2) > 12).mean() < 0.0002
    visitor.choose("Change")
    changed = visitor.wait_until_drawn(placement="canonical", surface="change")
    red, _, blue = np.moveaxis(changed, 2, 0)
    assert (np.abs(red - blue) > 60).mean() > 0.001
