"""What is made of a finished fit: asked for, looked at, kept, erased."""

import pytest
from playwright.sync_api import expect

from tests.e2e.page.visitor import FIT_WITHIN_MS, Visitor


@pytest.fixture
def looking(visitor: Visitor, finished_fit: str) -> Visitor:
    visitor.page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    visitor.wait_for_result()
    return visitor


def test_a_report_is_made_kept_and_erased(looking: Visitor):
    page = looking.page
    made = page.locator(".derived > li")
    looking.choose("Report")
    page.get_by_role("button", name="Make the report").click()
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
    expect(page.get_by_role("img", name="Other pose of the body")).to_be_visible(
        timeout=FIT_WITHIN_MS
    )
    looking.choose("Caricature")
    page.get_by_label("Times").fill("1.5")
    page.get_by_role("button", name="Make the caricature").click()
    expect(page.get_by_role("img", name="Caricature of the body")).to_be_visible(
        timeout=FIT_WITHIN_MS
    )
    expect(page.locator(".derived > li")).to_have_count(2)
