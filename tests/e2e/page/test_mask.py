"""The mask before the fit: seen, corrected by brushes, sent only if it was."""

import base64
import io

import httpx
import numpy as np
from PIL import Image
from playwright.sync_api import Browser, Page, expect

from tests.e2e.page.test_proposals import WOMAN, drop
from tests.e2e.page.visitor import PHONE, STAGE_MARGIN, Visitor, serious_findings

PICTURE_SIZE = (540, 720)
CORNER, HEART = (60.0, 60.0), (265.0, 270.0)
"""A spot of the wall and one of the person."""

SHOWN_AT = """([selector, x, y]) => {
  const canvas = document.querySelector(selector);
  const box = canvas.getBoundingClientRect();
  const scale = canvas.width / box.width;
  const [column, row] = [x - box.x, y - box.y].map((each) => Math.round(each * scale));
  return canvas.getContext("2d").getImageData(column, row, 1, 1).data[3];
}"""
IS_SHOWN_AT = f"([wanted, ...at]) => (({SHOWN_AT})(at) > 0) === wanted"
STAGE_MASK = ".mask-stage .mask-layer"


def on_mask_stage(visitor: Visitor, spot: tuple[float, float]) -> tuple[float, float]:
    """Where a pixel of the whole picture lies within the window."""
    box = visitor.page.locator(".mask-stage").bounding_box()
    assert box is not None
    width, height = PICTURE_SIZE
    room = (box["width"] - 2 * STAGE_MARGIN, box["height"] - 2 * STAGE_MARGIN)
    scale = min(room[0] / width, room[1] / height)
    return (
        box["x"] + (box["width"] - scale * width) / 2 + scale * spot[0],
        box["y"] + (box["height"] - scale * height) / 2 + scale * spot[1],
    )


def wait_for_mask(visitor: Visitor, spot: tuple[float, float], *, is_person: bool) -> None:
    """Wait until the mask shown has this pixel of the picture, or has it not."""
    at = on_mask_stage(visitor, spot)
    visitor.page.wait_for_function(IS_SHOWN_AT, arg=[is_person, STAGE_MASK, *at])


def open_brushes(visitor: Visitor) -> None:
    page = visitor.page
    drop(visitor, WOMAN.read_bytes())
    visitor.correct()
    page.get_by_role("button", name="Look and adjust").click()
    expect(page.locator(".mask-stage")).to_have_attribute("aria-busy", "false")
    wait_for_mask(visitor, HEART, is_person=True)
    wait_for_mask(visitor, CORNER, is_person=False)


def paint(visitor: Visitor, spot: tuple[float, float]) -> None:
    """A short stroke over a spot."""
    x, y = on_mask_stage(visitor, spot)
    mouse = visitor.page.mouse
    mouse.move(x - 8, y)
    mouse.down()
    mouse.move(x + 8, y, steps=4)
    mouse.up()


def ready_to_fit(page: Page) -> None:
    page.get_by_role("radio", name="Female", exact=True).check()
    page.get_by_label("Height", exact=True).fill("168")


def test_the_mask_is_seen_with_the_points_and_not_sent_unless_edited(visitor: Visitor):
    page = visitor.page
    drop(visitor, WOMAN.read_bytes())
    visitor.correct()
    expect(page.get_by_role("heading", name="Mask of the person")).to_be_visible()
    expect(page.get_by_role("img", name="The picture with the mask")).to_be_visible()
    ready_to_fit(page)
    assert "mask_id" not in visitor.sent_view()


def test_what_brushes_add_and_remove_reaches_the_fit(visitor: Visitor, service: httpx.Client):
    page = visitor.page
    open_brushes(visitor)
    paint(visitor, CORNER)
    wait_for_mask(visitor, CORNER, is_person=True)
    visitor.choose("Remove")
    page.get_by_role("slider", name="Size").fill("80")
    paint(visitor, HEART)
    wait_for_mask(visitor, HEART, is_person=False)
    ready_to_fit(page)
    with page.expect_response(
        lambda answer: answer.request.method == "POST" and answer.url.endswith("/v1/fits")
    ) as answered:
        assert "mask_id" in visitor.sent_view()
    sent = service.get(answered.value.json()["links"]["files"]["views/0/mask"]).raise_for_status()
    assert sent.headers["content-type"] == "image/png"
    mask = np.asarray(Image.open(io.BytesIO(sent.content)).convert("L"))
    assert mask.shape == PICTURE_SIZE[::-1]
    assert set(np.unique(mask)) == {0, 255}
    assert mask[int(CORNER[1]), int(CORNER[0])] == 255
    assert mask[int(HEART[1]), int(HEART[0])] == 0
    # Away from both strokes it is as it was proposed.
    proposed = service.post(
        "/v1/points",
        files={"image": WOMAN.read_bytes(), "request": b'{"mask": true}'},
    ).json()["mask"]
    as_proposed = np.asarray(Image.open(io.BytesIO(base64.b64decode(proposed)))) >= 128
    legs = slice(450, None)
    assert (as_proposed[legs] == (mask[legs] == 255)).mean() > 0.999


def test_strokes_are_undone_redone_and_discarded(visitor: Visitor):
    page = visitor.page
    open_brushes(visitor)
    paint(visitor, CORNER)
    wait_for_mask(visitor, CORNER, is_person=True)
    page.keyboard.press("Control+z")
    wait_for_mask(visitor, CORNER, is_person=False)
    expect(page.get_by_role("button", name="Undo the last stroke")).to_be_disabled()
    page.get_by_role("button", name="Redo the stroke").click()
    wait_for_mask(visitor, CORNER, is_person=True)
    tools = page.get_by_role("toolbar", name="Mask")
    tools.get_by_role("button", name="Discard the edits").click()
    wait_for_mask(visitor, CORNER, is_person=False)
    tools.get_by_role("button", name="Done").click()
    expect(visitor.points()).to_have_count(21)
    ready_to_fit(page)
    assert "mask_id" not in visitor.sent_view()


def test_brushes_need_no_pointer(visitor: Visitor):
    page = visitor.page
    open_brushes(visitor)
    expect(page.locator(".mask-stage")).to_be_focused()
    # From the middle of the picture, which is the person's.
    page.keyboard.press("ArrowUp")
    page.keyboard.press("x")
    expect(page.get_by_role("radio", name="Remove", exact=True)).to_be_checked()
    wait_for_mask(visitor, (270.0, 330.0), is_person=True)
    for _ in range(3):
        page.keyboard.press("Shift+ArrowUp")
    page.keyboard.press("]")
    page.keyboard.press("Enter")
    wait_for_mask(visitor, (270.0, 328.0), is_person=False)
    page.keyboard.press("Control+z")
    wait_for_mask(visitor, (270.0, 328.0), is_person=True)


def test_the_picture_is_enlarged_and_moved_under_the_brush(visitor: Visitor):
    page = visitor.page
    open_brushes(visitor)
    picture = page.locator(".mask-stage .stage-picture")
    whole = picture.bounding_box()
    assert whole is not None
    tools = page.get_by_role("toolbar", name="Mask")
    for _ in range(3):
        tools.get_by_role("button", name="Zoom in").click()
    visitor.wait_for_width(picture, 3.0 * whole["width"])
    before = picture.bounding_box()
    stage = page.locator(".mask-stage").bounding_box()
    assert before is not None
    assert stage is not None
    page.keyboard.down("Shift")
    page.mouse.move(stage["x"] + 300, stage["y"] + 300)
    page.mouse.down()
    page.mouse.move(stage["x"] + 300, stage["y"] + 240, steps=4)
    page.mouse.up()
    page.keyboard.up("Shift")
    after = picture.bounding_box()
    assert after is not None
    assert before["y"] - after["y"] > 30
    expect(tools.get_by_role("button", name="Undo the last stroke")).to_be_disabled()


def test_axe_finds_nothing_serious_in_masks(browser: Browser, service: httpx.Client, axe: str):
    with Visitor.at(browser, str(service.base_url), PHONE, color_scheme="dark") as visitor:
        page = visitor.page
        open_brushes(visitor)
        assert serious_findings(page, axe) == []
        assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")
        paint(visitor, CORNER)
        page.get_by_role("toolbar", name="Mask").get_by_role("button", name="Done").click()
        expect(page.get_by_role("img", name="The border of the mask")).to_be_visible()
        assert serious_findings(page, axe) == []


def test_in_the_full_screen_one_finger_paints_and_two_move_and_paint_nothing(
    browser: Browser, service: httpx.Client
):
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        open_brushes(visitor)
        before = page.locator(".mask-stage").bounding_box()
        assert before is not None
        page.get_by_role("button", name="Fill the screen").tap()
        page.wait_for_function(
            "(height) => document.querySelector('.mask-stage').clientHeight > height",
            arg=before["height"] + 50,
        )
        visitor.wait_for_whole_picture()
        wait_for_mask(visitor, HEART, is_person=True)
        session = page.context.new_cdp_session(page)

        def touch(kind: str, *at: tuple[float, float]) -> None:
            points = [{"x": x, "y": y} for x, y in at]
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        undo = page.get_by_role("button", name="Undo the last stroke")
        x, y = on_mask_stage(visitor, CORNER)
        # The second finger comes late: what the first has painted by then is gone.
        touch("touchStart", (x - 12, y))
        touch("touchMove", (x, y))
        wait_for_mask(visitor, CORNER, is_person=True)
        touch("touchStart", (x, y), (x + 80, y))
        wait_for_mask(visitor, CORNER, is_person=False)
        picture = page.locator(".mask-stage .stage-picture")
        width = picture.bounding_box()["width"]
        for apart in (10, 20, 30):
            touch("touchMove", (x, y), (x + 80 + apart, y))
        touch("touchEnd")
        visitor.wait_for_width(picture, 1.2 * width)
        expect(undo).to_be_disabled()
        page.get_by_role("button", name="Show the whole picture").tap()
        visitor.wait_for_width(picture, width - 1, width + 1)

        touch("touchStart", (x - 12, y))
        touch("touchMove", (x, y))
        touch("touchEnd")
        wait_for_mask(visitor, CORNER, is_person=True)
        expect(undo).to_be_enabled()
        # Back to the points, which fill the screen too.
        page.get_by_role("toolbar", name="Mask").get_by_role("button", name="Done").tap()
        expect(page.get_by_role("img", name="The border of the mask")).to_be_visible()
        expect(page.get_by_role("button", name="Leave the full screen")).to_be_visible()
        expect(visitor.stage).to_be_focused()
