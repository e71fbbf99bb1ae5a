"""What is made of a finished fit: asked for, looked at, kept, erased."""

import io
import json
import re
from collections.abc import Callable
from pathlib import Path

import httpx
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Request, Route, expect

from service.demo_data.sample import load_sample
from tests.e2e.page.visitor import FIT_WITHIN_MS, VISIBLY, Visitor
from tests.e2e.service import ended_job

NOTE_PLAYING_ON = """(moving) => {
  window.playedOn = 0;
  const { src } = moving;
  new MutationObserver(() => {
    const buttons = [...document.querySelectorAll("button")];
    const held = buttons.some(({ textContent }) => textContent === "Play");
    if (held && document.querySelector(`img[src="${src}"]`)) window.playedOn += 1;
  }).observe(document, { subtree: true, childList: true, characterData: true });
}"""


def asks_for(kind: str) -> Callable[[Request], bool]:
    """Whether a request does: the page asks for the skin by itself, at any time."""
    return lambda request: f'"kind":"{kind}"' in (request.post_data or "")


@pytest.fixture
def looking(visitor: Visitor, bare_fit: str) -> Visitor:
    """Someone before a fit of which nothing is made yet."""
    visitor.page.goto(f"{visitor.origin}/#/fits/{bare_fit}")
    visitor.wait_for_result()
    return visitor


def test_a_report_is_made_kept_and_erased(looking: Visitor):
    page = looking.page
    made = page.locator(".derived > li")
    looking.choose("Report")
    page.get_by_label("Name in the heading, if you like").fill("Ada L.")
    with page.expect_request(asks_for("report")) as sent:
        page.get_by_role("button", name="Make the report").click()
    asked = sent.value.post_data_json
    assert (asked["name"], asked["units"], asked["language"]) == ("Ada L.", "metric", "en")
    assert re.fullmatch(r"\d{4}-\d\d-\d\d", asked["date"])
    file = made.get_by_role("button", name="report.pdf")
    expect(file).to_be_visible(timeout=FIT_WITHIN_MS)
    with page.expect_download() as download:
        file.click()
    assert download.value.path().read_bytes()[:5] == b"%PDF-"
    # What was made stands there when one comes back.
    page.reload()
    expect(file).to_be_visible()
    made.get_by_role("button", name="Delete: report").click()
    expect(made).to_have_count(0)
    page.reload()
    looking.wait_for_result()
    expect(page.get_by_role("heading", name="Make something of it")).to_be_visible()
    expect(made).to_have_count(0)


def test_another_pose_and_a_caricature_are_shown_and_what_cannot_be_is_told(looking: Visitor):
    page = looking.page
    looking.choose("Other pose")
    page.get_by_label("Pose", exact=True).select_option(label="Sitting")
    page.get_by_role("button", name="Make the other pose").click()
    turned = page.get_by_role("img", name="The body in this pose; arrow keys turn it")
    expect(turned).to_have_attribute("data-shows", "texture", timeout=FIT_WITHIN_MS)
    looking.choose("From the sides")
    expect(page.get_by_role("img", name="Other pose of the body")).to_be_visible()
    looking.choose("Caricature")
    page.get_by_label("Exaggeration").fill("1.5")
    page.get_by_role("button", name="Make the caricature").click()
    turned = page.get_by_role("img", name="The caricature; arrow keys turn it")
    expect(turned).to_have_attribute("data-shows", "clay", timeout=FIT_WITHIN_MS)
    looking.choose("Beside the body")
    expect(page.get_by_role("img", name="Caricature of the body")).to_be_visible()
    for made in ("Other pose", "Caricature"):
        expect(page.locator(".derived > li").filter(has_text=made).first).to_be_visible()


def test_an_animation_plays_in_the_viewer_and_its_film_until_it_is_held_still(
    looking: Visitor, service: httpx.Client, bare_fit: str
):
    page = looking.page
    page.emulate_media(reduced_motion="no-preference")
    looking.choose("Animation")
    page.get_by_label("Choose a BVH file").set_input_files(
        {"name": "dance.bvh", "mimeType": "text/plain", "buffer": b"no motion"}
    )
    expect(page.get_by_text("It moves as dance.bvh says.")).to_be_visible()
    page.get_by_role("button", name="Make the animation").click()
    expect(page.get_by_role("alert")).to_contain_text("does not begin with HIERARCHY")
    looking.choose("Walk")
    expect(page.get_by_text("It moves as dance.bvh says.")).to_have_count(0)
    page.get_by_role("button", name="Make the animation").click()
    # In the viewer: played, stopped, sought, and turned meanwhile.
    body = page.get_by_role("img", name="The body in motion, to turn; arrow keys turn it")
    expect(body).to_have_attribute("data-shows", re.compile("clay|texture"), timeout=FIT_WITHIN_MS)
    looking.wait_for_change(body, looking.pixels(body), share=0.002)
    page.get_by_role("button", name="Stop", exact=True).click()
    page.get_by_role("slider", name="Moment of the motion").fill("0.5")
    early = looking.wait_until_still(body)
    page.get_by_role("slider", name="Moment of the motion").fill("2")
    late = looking.wait_for_change(body, early, share=0.002)
    body.press("ArrowRight")
    looking.wait_for_change(body, late, share=0.01)
    looking.choose("0.25 ×")
    looking.choose("Film")
    moving = page.get_by_role("img", name="The body in motion", exact=True)
    expect(moving).to_have_attribute("data-shows", "animation.webp", timeout=FIT_WITHIN_MS)
    looking.wait_for_change(moving, looking.pixels(moving), share=0.002)
    made = page.locator(".derived > li").first
    expect(made).to_contain_text("Walk: 3.3 s, over")
    # What lies below stays where it is.
    below = page.get_by_role("button", name="body_skinned.glb")
    place = below.evaluate("button => button.offsetTop")
    moving.evaluate(NOTE_PLAYING_ON)
    for button, shown in (
        ("Hold still", "animation.png"),
        ("Play", "animation.webp"),
        ("Hold still", "animation.png"),
    ):
        page.get_by_role("button", name=button).click()
        expect(moving).to_have_attribute("data-shows", shown)
        assert below.evaluate("button => button.offsetTop") == place
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    assert page.evaluate("window.playedOn") == 0
    # What is shown cannot move: it is the file of a single frame.
    (job,) = (
        each
        for each in service.get(f"/v1/fits/{bare_fit}/derivations").json()["derivations"]
        if each["kind"] == "animation"
    )
    still = Image.open(io.BytesIO(service.get(job["links"]["artifacts"]["animation.png"]).content))
    assert getattr(still, "n_frames", 1) == 1
    size = moving.evaluate("image => [image.naturalWidth, image.naturalHeight]")
    assert tuple(size) == still.size
    with page.expect_download() as download:
        made.get_by_role("button", name="body_skinned.glb").click()
    assert download.value.path().read_bytes()[:4] == b"glTF"


def test_the_motion_is_chosen_beside_the_body_and_made_once(looking: Visitor):
    page = looking.page
    looking.choose("Animation")
    page.get_by_role("radio", name="Squat", exact=True).check()
    with page.expect_request(asks_for("animation")) as sent:
        page.get_by_role("button", name="Make the animation").click()
    assert sent.value.post_data_json["motion"] == "squat"
    stage = page.locator(".bench-stage")
    body = stage.get_by_role("img", name="The body in motion, to turn; arrow keys turn it")
    expect(body).to_have_attribute("data-shows", re.compile("clay|texture"), timeout=FIT_WITHIN_MS)
    wave = stage.get_by_role("radio", name="Wave", exact=True)
    expect(stage.get_by_role("radio", name="Squat", exact=True)).to_be_checked()
    stage.get_by_role("slider", name="Moment of the motion").fill("1.3")
    low = looking.pixels(body)
    with page.expect_request(asks_for("animation")) as sent:
        wave.check()
    assert sent.value.post_data_json == {"kind": "animation", "motion": "wave"}
    expect(stage.get_by_text("Being made: Wave")).to_be_visible()
    made = page.locator(".derived > li").filter(has_text="Animation")
    expect(made).to_have_count(2)
    expect(made.first).to_contain_text("Wave: 4.2 s", timeout=FIT_WITHIN_MS)
    expect(stage.get_by_text("Being made")).to_have_count(0)
    stage.get_by_role("slider", name="Moment of the motion").fill("1.3")
    looking.wait_for_change(body, low, share=0.01)
    # What was made before is shown again.
    stage.get_by_role("radio", name="Squat", exact=True).check()
    expect(made.nth(1).get_by_role("button", name="Show large")).to_have_attribute(
        "aria-pressed", "true"
    )
    expect(made).to_have_count(2)


def test_a_texture_is_shown_with_where_it_comes_from(looking: Visitor):
    page = looking.page
    looking.choose("Texture")
    looking.choose("Without the light")
    page.get_by_label("Size", exact=True).select_option("512")
    page.get_by_role("button", name="Make the texture").click()
    body = page.get_by_role("img", name="The textured body; arrow keys turn it")
    expect(body).to_have_attribute("data-shows", "texture", timeout=FIT_WITHIN_MS)
    front = looking.pixels(body)
    assert (np.ptp(front, axis=2) > VISIBLY).mean() > 0.02
    body.press("ArrowRight")
    looking.wait_for_change(body, front, share=0.01)
    looking.choose("The texture")
    texture = page.get_by_role("img", name="Texture of the body")
    expect(texture).to_be_visible()
    assert texture.evaluate("image => image.decode().then(() => image.naturalWidth)") == 512
    looking.choose("Where from")
    expect(page.get_by_role("img", name="Where the texture comes from")).to_be_visible()
    expect(page.get_by_text("white is from the picture, grey is mirrored")).to_be_visible()
    made = page.locator(".derived > li").first
    expect(made).to_contain_text("% of the skin is from the picture")
    with page.expect_download() as download:
        made.get_by_role("button", name="body_textured.glb").click()
    assert download.value.path().read_bytes()[:4] == b"glTF"


def test_a_texture_of_ones_own_is_laid_on_the_body(looking: Visitor, tmp_path: Path):
    page = looking.page
    looking.choose("Texture")
    looking.choose("My own")
    make = page.get_by_role("button", name="Make the texture")
    expect(make).to_be_disabled()
    oblong, square = tmp_path / "oblong.png", tmp_path / "square.png"
    Image.new("RGB", (256, 128)).save(oblong)
    Image.new("RGB", (256, 256), (30, 160, 60)).save(square)
    page.get_by_label("Choose a texture").set_input_files(oblong)
    make.click()
    expect(page.get_by_role("alert")).to_contain_text("texture")
    page.get_by_label("Another texture").set_input_files(square)
    expect(page.get_by_text("square.png is laid on the body.")).to_be_visible()
    make.click()
    body = page.get_by_role("img", name="The textured body; arrow keys turn it")
    expect(body).to_have_attribute("data-shows", "texture", timeout=FIT_WITHIN_MS)
    red, green, blue = np.moveaxis(looking.pixels(body), 2, 0)
    assert (green > 1.5 * np.maximum(red, blue)).mean() > 0.02


def test_a_texture_made_before_is_neither_the_skin_nor_hidden(
    visitor: Visitor, service: httpx.Client, bare_fit: str
):
    page = visitor.page
    derivations = f"/v1/fits/{bare_fit}/derivations"
    small = {"kind": "texture", "colours": "picture", "size": 512}
    before = ended_job(service, service.post(derivations, json=small))
    page.goto(f"{visitor.origin}/#/fits/{bare_fit}")
    visitor.wait_for_result()
    skin = page.locator(".look-beside canvas")
    expect(skin).to_have_attribute("data-shows", "texture", timeout=FIT_WITHIN_MS)
    expect(page.locator(".derived > li")).to_have_count(1)
    expect(page.locator(".derived > li")).to_contain_text("Texture")
    made = service.get(derivations).json()["derivations"]
    asked = [service.get(each["links"]["request"]).json()["size"] for each in made]
    assert (made[-1]["id"], asked) == (before["id"], [1024, 512])


def test_fits_of_one_person_are_offered_and_combined(looking: Visitor, service: httpx.Client):
    """Of the fits this browser knows: one told the same of the person, one another height."""
    page = looking.page
    for height_m in (1.804, 1.7):
        told = json.loads(load_sample().request) | {"height_m": height_m, "cues": "SE"}
        files = {
            "image": ("sample.jpg", load_sample().image, "image/jpeg"),
            "request": ("request.json", json.dumps(told), "application/json"),
        }
        job = ended_job(service, service.post("/v1/fits", files=files))
        assert job["state"] == "succeeded"
        page.goto(f"{looking.origin}/#/fits/{job['id']}")
        looking.wait_for_result()
        expect(page.locator(".badge")).to_have_text("2" if height_m == 1.804 else "3")
    page.get_by_role("button", name="Fits").click()
    expect(page.get_by_role("dialog").get_by_text("Man, 170 cm")).to_be_visible()
    page.keyboard.press("Escape")
    page.go_back()
    page.go_back()
    looking.wait_for_result()
    looking.choose("Combined body")
    others = page.get_by_role("group", name="Other pictures of this person")
    expect(others).to_have_attribute("aria-busy", "false")
    expect(others.get_by_role("checkbox")).to_have_count(1)
    make = page.get_by_role("button", name="Make the combined body")
    expect(make).to_be_disabled()
    others.get_by_role("checkbox").check()
    make.click()
    table = page.get_by_role("table", name="Measurements of the combined body")
    expect(table).to_be_visible(timeout=FIT_WITHIN_MS)
    expect(table.get_by_role("row", name=re.compile(r"^Hip \d"))).to_contain_text("–")
    expect(page.locator(".derived > li").first).to_contain_text("From 2 pictures.")
    for number in (1, 2):
        looking.choose(f"Picture {number}")
        over = page.get_by_role("img", name=f"Combined body over picture {number}")
        expect(over).to_be_visible()


def test_a_figure_is_drawn_from_where_one_wants(looking: Visitor):
    page = looking.page
    looking.choose("Figure")
    page.get_by_label("Seen from").fill("45")
    expect(page.get_by_text("45° right")).to_be_visible()
    page.get_by_role("button", name="Make the figure").click()
    expect(page.get_by_role("img", name="Picture, overlay, body and new pose")).to_be_visible(
        timeout=FIT_WITHIN_MS
    )
    looking.choose("Turn it")
    body = page.get_by_role("img", name="The body in this pose; arrow keys turn it")
    expect(body).to_have_attribute("data-shows", "clay")


def test_what_was_made_is_shown_large_on_the_stage_with_a_way_back(looking: Visitor):
    page = looking.page
    stage = page.locator(".bench-stage")
    looking.unfold_for_experts()
    looking.choose("Residual")
    looking.choose("Figure")
    page.get_by_role("button", name="Make the figure").click()
    picture = stage.get_by_role("img", name="Picture, overlay, body and new pose")
    expect(picture).to_be_visible(timeout=FIT_WITHIN_MS)
    assert picture.bounding_box()["width"] > 0.9 * stage.bounding_box()["width"]
    expect(stage.locator("b", has_text="Figure")).to_be_visible()
    expect(looking.body).to_be_hidden()
    stage.get_by_role("button", name="Back to the body").click()
    expect(picture).to_have_count(0)
    expect(looking.body).to_be_visible()
    # As it was left.
    expect(page.get_by_role("radio", name="Residual", exact=True)).to_be_checked()
    page.get_by_role("button", name="Show large: figure").click()
    expect(picture).to_be_visible()
    page.get_by_role("button", name="Delete: figure").click()
    expect(picture).to_have_count(0)
    expect(looking.body).to_be_visible()


def test_a_caricature_that_is_refused_is_offered_as_strong_as_it_can_be(looking: Visitor):
    page = looking.page
    looking.choose("Caricature")
    page.get_by_label("Exaggeration").fill("5")
    page.get_by_role("button", name="Make the caricature").click()
    smaller = page.get_by_role("button", name=re.compile(r"^Make it [\d.]+ times$"))
    expect(smaller).to_be_visible(timeout=FIT_WITHIN_MS)
    expect(page.get_by_role("button", name="Try again")).to_have_count(0)
    largest = float(re.search(r"[\d.]+", smaller.inner_text())[0])
    assert 1.0 < largest < 5.0
    with page.expect_request(asks_for("caricature")) as sent:
        smaller.click()
    assert sent.value.post_data_json["factor"] == largest
    expect(page.get_by_role("img", name="The caricature; arrow keys turn it")).to_be_visible(
        timeout=FIT_WITHIN_MS
    )


def test_that_pictures_show_different_people_is_said_before_anything_else(
    looking: Visitor, service: httpx.Client, bare_fit: str
):
    """What is made is a pose, answered as if it were a body of several pictures that disagree."""
    page = looking.page
    warning = {"code": "different-people", "message": "The pictures seem to show two people."}
    job = ended_job(
        service, service.post(f"/v1/fits/{bare_fit}/derivations", json={"kind": "pose"})
    )

    def warned(route: Route) -> None:
        answer = route.fetch()
        route.fulfill(response=answer, json=answer.json() | {"warnings": [warning]})

    page.route(f"**{job['links']['result']}", warned)
    page.reload()
    looking.wait_for_result()
    card = page.locator(".derived > li")
    expect(card.locator(".note.is-problem")).to_contain_text("seem to show different people")
    page.get_by_role("button", name="Show large: other pose").click()
    note = page.locator(".bench-stage .note.is-problem")
    canvas = page.get_by_role("img", name="The body in this pose; arrow keys turn it")
    expect(canvas).to_be_visible()
    assert note.bounding_box()["y"] < canvas.bounding_box()["y"]
    in_card = card.locator(".note").bounding_box()["y"]
    assert in_card < card.get_by_role("button", name="Show large").bounding_box()["y"]
