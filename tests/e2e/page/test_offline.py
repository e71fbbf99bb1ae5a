"""Without a connection somebody can go on clicking, and it is said that there is none."""

from playwright.sync_api import expect

from tests.e2e.page.test_proposals import WOMAN
from tests.e2e.page.visitor import LIMBS, Visitor

NO_CONNECTION = "You are offline."
GOES_ON = "There is no connection. The service goes on"


def test_offline_is_said_and_all_is_sent_once_it_is_over(visitor: Visitor):
    page = visitor.page
    visitor.open_sample()
    visitor.describe_person()
    expect(page.get_by_text(NO_CONNECTION)).to_have_count(0)
    page.context.set_offline(True)
    expect(page.get_by_text(NO_CONNECTION)).to_be_visible()
    visitor.click_points(LIMBS)
    page.context.set_offline(False)
    expect(page.get_by_text(NO_CONNECTION)).to_have_count(0)
    expect(page.locator(".live-outline")).to_be_attached()


def test_a_picture_chosen_offline_is_uploaded_later(visitor: Visitor):
    page = visitor.page
    visitor.open_sample()
    page.context.set_offline(True)
    page.get_by_label("Choose another picture").set_input_files(WOMAN)
    # Nobody proposes its points now, so that the page itself unfolds where they are clicked.
    expect(page.get_by_text(WOMAN.name)).to_be_visible()
    expect(page.get_by_text(NO_CONNECTION)).to_be_visible()
    with page.expect_response("**/v1/images") as answer:
        page.context.set_offline(False)
    assert answer.value.ok
    expect(page.get_by_text(NO_CONNECTION)).to_have_count(0)


def test_a_service_that_does_not_answer_is_tried_again(visitor: Visitor):
    page = visitor.page
    page.route("**/v1/images", lambda route: route.abort())
    visitor.open_sample(with_points=True)
    expect(page.get_by_text(NO_CONNECTION)).to_be_visible()
    page.unroute("**/v1/images")
    with page.expect_response("**/v1/images") as answer:
        pass
    assert answer.value.ok
    expect(page.get_by_text(NO_CONNECTION)).to_have_count(0)


def test_a_fit_whose_news_breaks_off_is_shown_once_there_is_a_connection_again(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(with_points=True)
    visitor.wait_for_whole_picture()
    page.route("**/v1/fits/*/events", lambda route: route.abort())
    page.route("**/v1/fits/*/cancel", lambda route: route.abort())
    visitor.let_fits_take_minutes()
    visitor.submit()
    expect(page.get_by_text(GOES_ON)).to_be_visible()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("button", name="Cancel")).to_be_enabled()
    page.unroute("**/v1/fits/*/events")
    page.unroute("**/v1/fits/*/cancel")
    expect(page.get_by_text(GOES_ON)).to_have_count(0)
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("heading", name="The fit was canceled")).to_be_visible()
