"""What is announced belongs to its screen: on the next one nothing of it is left."""

from playwright.sync_api import expect

from tests.e2e.page.visitor import Visitor


def test_the_last_click_is_not_told_on_the_next_screen(visitor: Visitor, finished_fit: str):
    page = visitor.page
    visitor.open_sample()
    visitor.click_points(("left_shoulder",))
    region = page.locator("#page > p[role=status]")
    expect(region).to_contain_text("Left shoulder placed.")
    page.evaluate(f"location.hash = '#/fits/{finished_fit}'")
    visitor.wait_for_result()
    expect(region).to_be_empty()
    page.get_by_role("link", name="New").click()
    page.get_by_role("link", name="Go on with sample.jpg").click()
    visitor.wait_for_stage()
    expect(region).to_be_empty()
