"""Brushes on a phone that fills its screen with the picture: one finger paints, two move it."""

import httpx
from playwright.sync_api import Browser, expect

from tests.e2e.page.test_mask import (
    CORNER,
    HEART,
    on_mask_stage,
    open_brushes,
    wait_for_mask,
)
from tests.e2e.page.visitor import PHONE, Visitor


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
