"""The camera of the measuring screen: opened, counting down, level, refused."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, Locator, Page, Playwright, expect

from service.demo_data import sample
from tests.e2e.page.browser import WHOLE, chromium
from tests.e2e.page.cameras import HeldPhone, camera_flags, permit, write_film
from tests.e2e.page.visitor import PHONE, Visitor

DATA = Path(sample.__file__).parent
CAMERA_IS_OFF = "() => document.querySelector('video') === null"


@pytest.fixture(scope="module")
def filming(playwright: Playwright, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """A browser before whose camera somebody stands, seen from the side."""
    film = tmp_path_factory.mktemp("film") / "side.mjpeg"
    write_film(film, DATA / "side.jpg")
    with chromium(playwright, *camera_flags(film), programs=WHOLE) as running:
        yield running


def place(page: Page, name: str) -> Locator:
    return page.locator(f'[data-place="{name}"]')


def open_camera(visitor: Visitor, name: str) -> Locator:
    page = visitor.page
    place(page, name).get_by_role("button", name="Take a picture").tap()
    return page.get_by_role("dialog", name=f"Camera: {name} picture")


def wait_for_video(camera: Locator) -> None:
    expect(camera.locator(".silhouette-outline")).to_be_visible()


def test_the_camera_counts_down_and_takes_the_picture_into_its_place(
    filming: Browser, service: httpx.Client
):
    with Visitor.at(filming, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        permit(page.context, visitor.origin)
        page.get_by_role("link", name="Measure", exact=True).tap()
        camera = open_camera(visitor, "side")
        wait_for_video(camera)
        video = camera.locator("video").bounding_box()
        outline = camera.locator(".silhouette-outline").bounding_box()
        assert video["height"] == pytest.approx(4 / 3 * video["width"], rel=0.02)
        assert outline["y"] >= video["y"]
        assert outline["y"] + outline["height"] <= video["y"] + video["height"]
        camera.get_by_role("radio", name="3 s", exact=True).check()
        camera.get_by_role("button", name="Take it in 3 s").tap()
        status = camera.get_by_role("status")
        expect(status).to_have_text("3")
        expect(status).to_have_text("2")
        expect(camera).to_be_hidden()
        page.wait_for_function(CAMERA_IS_OFF)
        expect(place(page, "side").get_by_alt_text("The side picture")).to_be_visible()
        expect(place(page, "side")).to_contain_text("Good to measure")
        assert place(page, "front").locator("img").count() == 0


def test_a_countdown_is_stopped_and_takes_nothing(filming: Browser, service: httpx.Client):
    with Visitor.at(filming, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        permit(page.context, visitor.origin)
        page.get_by_role("link", name="Measure", exact=True).tap()
        camera = open_camera(visitor, "front")
        wait_for_video(camera)
        camera.get_by_role("button", name="Take it in 5 s").tap()
        camera.get_by_role("button", name="Stop").tap()
        expect(camera.get_by_role("button", name="Take it in 5 s")).to_be_enabled()
        expect(camera.get_by_role("status")).to_have_text("")
        camera.get_by_role("button", name="Close").tap()
        page.wait_for_function(CAMERA_IS_OFF)
        assert place(page, "front").locator("img").count() == 0


def test_the_level_says_where_to_turn_in_portrait_and_in_landscape(
    filming: Browser, service: httpx.Client
):
    with Visitor.at(filming, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        permit(page.context, visitor.origin)
        page.get_by_role("link", name="Measure", exact=True).tap()
        phone = HeldPhone(page)
        camera = open_camera(visitor, "front")
        level = camera.locator(".camera-level")
        expect(level).to_have_text("Level")
        # Near upright a roll turns gamma by a quarter: 95 and -90 is rolled clockwise by five.
        phone.hold(beta=95.0, gamma=-90.0)
        expect(level).to_have_text("Turn the phone to the left")
        phone.hold(beta=85.0, gamma=-90.0)
        expect(level).to_have_text("Turn the phone to the right")
        phone.hold(beta=80.0, gamma=0.0)
        expect(level).to_have_text("The camera looks down: tilt it up")
        phone.hold(beta=100.0, gamma=0.0)
        expect(level).to_have_text("The camera looks up: tilt it down")
        phone.turn_to_landscape()
        phone.hold(beta=0.0, gamma=-90.0)
        expect(level).to_have_text("Level")
        # The top of the phone lies at the left: raised, it is rolled clockwise.
        phone.hold(beta=6.0, gamma=-90.0)
        expect(level).to_have_text("Turn the phone to the left")
        phone.hold(beta=-6.0, gamma=-90.0)
        expect(level).to_have_text("Turn the phone to the right")


def test_a_refused_camera_says_so_and_offers_the_file_picker(
    filming: Browser, service: httpx.Client
):
    with Visitor.at(filming, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        page.get_by_role("link", name="Measure", exact=True).tap()
        camera = open_camera(visitor, "front")
        expect(camera.get_by_role("alert")).to_contain_text("The camera is blocked for this page")
        expect(camera.get_by_role("button", name="Take it in 5 s")).to_be_disabled()
        with page.expect_file_chooser() as chooser:
            camera.get_by_text("Choose a file", exact=True).tap()
        chooser.value.set_files(DATA / "front.jpg")
        expect(camera).to_be_hidden()
        expect(place(page, "front")).to_contain_text("Good to measure")


def test_only_the_camera_and_the_sensors_of_its_level_are_permitted(visitor: Visitor):
    permitted = visitor.page.evaluate("document.featurePolicy.allowedFeatures()")
    assert {"camera", "accelerometer", "gyroscope"} <= set(permitted)
    assert not {"microphone", "geolocation"} & set(permitted)
