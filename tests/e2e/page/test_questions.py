"""A question is left by Escape, and the focus is where it was asked from."""

from playwright.sync_api import expect

from tests.e2e.page.visitor import Visitor


def test_escape_leaves_the_question_whether_to_delete(visitor: Visitor, finished_fit: str):
    page = visitor.page
    page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    visitor.wait_for_result()
    asker = page.get_by_role("button", name="Delete this fit")
    asker.click()
    expect(page.get_by_role("button", name="Keep", exact=True)).to_be_focused()
    page.keyboard.press("Escape")
    expect(page.get_by_role("button", name="Delete", exact=True)).to_have_count(0)
    expect(asker).to_be_focused()
    # It asks again, and nothing was deleted.
    page.keyboard.press("Enter")
    expect(page.get_by_role("button", name="Keep", exact=True)).to_be_focused()
    page.keyboard.press("Enter")
    expect(asker).to_be_focused()
    page.reload()
    visitor.wait_for_result()
