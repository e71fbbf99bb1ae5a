"""What a visitor shows to others: a film of the body turning, and the photo beside the body."""

import io

import cv2
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Download, Locator, expect

from tests.e2e.page.visitor import FIT_WITHIN_MS, VISIBLY, Visitor

WITHOUT_RECORDER = "delete window.MediaRecorder"
COUNT_WHAT_IS_OPEN = """
window.open_bitmaps = 0;
window.filmed_tracks = [];
const { captureStream } = HTMLCanvasElement.prototype;
HTMLCanvasElement.prototype.captureStream = function (...rate) {
  const stream = captureStream.apply(this, rate);
  window.filmed_tracks.push(...stream.getTracks());
  return stream;
};
const decode = window.createImageBitmap;
window.createImageBitmap = (...of) => (window.open_bitmaps++, decode(...of));
const { close } = ImageBitmap.prototype;
ImageBitmap.prototype.close = function () { window.open_bitmaps--; close.call(this); };
void 0;"""
SHEET = """
window.taken = [];
window.refusals = 0;
navigator.canShare = ({ files }) => files.length === 1;
navigator.share = ({ files }) => {
  if (window.refusals-- > 0) return Promise.reject(new DOMException("", "NotAllowedError"));
  window.taken.push(`${files[0].name} ${files[0].type}`);
  return Promise.resolve();
};
void 0;"""


@pytest.fixture
def looking(visitor: Visitor, finished_fit: str) -> Visitor:
    visitor.page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    visitor.wait_for_result()
    return visitor


def sharing(visitor: Visitor) -> Locator:
    return visitor.page.get_by_role("group", name="To share")


def film(visitor: Visitor) -> Locator:
    return sharing(visitor).get_by_role("button", name="Share a short film: the body turns once")


def pair(visitor: Visitor) -> Locator:
    return sharing(visitor).get_by_role("button", name="Share a picture: the photo beside the body")


def picture_of(download: Download) -> np.ndarray:
    opened = Image.open(io.BytesIO(download.path().read_bytes())).convert("RGB")
    return np.asarray(opened).astype(int)


def frames_of(download: Download) -> list[np.ndarray]:
    """Of a film, whatever its container."""
    film = cv2.VideoCapture(str(download.path()))
    frames: list[np.ndarray] = []
    while (read := film.read())[0]:
        frames.append(read[1].astype(int))
    film.release()
    return frames


def test_the_photo_stands_beside_the_body_at_the_same_scale(looking: Visitor):
    with looking.page.expect_download() as download:
        pair(looking).click()
    assert download.value.suggested_filename == "before_and_after.png"
    seen = picture_of(download.value)
    width = (seen.shape[1] - 4) // 2
    photo, body = seen[:, :width], seen[:, -width:]
    assert seen.shape[0] > 600
    assert np.abs(photo - body).max(axis=2).mean() > VISIBLY
    ground = body[0, 0]
    shown = np.abs(body - ground).max(axis=2) > VISIBLY
    rows, columns = np.flatnonzero(shown.any(axis=1)), np.flatnonzero(shown.any(axis=0))
    # From head to sole with its margin, and in the middle: the crop goes by the body.
    assert 0.8 < np.ptp(rows) / len(body) < 0.95
    assert abs(columns.mean() / width - 0.5) < 0.05
    assert 0.1 < shown.mean() < 0.6


def test_the_body_is_filmed_turning_once(looking: Visitor):
    with looking.page.expect_download(timeout=FIT_WITHIN_MS) as download:
        film(looking).click()
        expect(film(looking)).to_be_disabled()
        expect(sharing(looking).get_by_text("Filming one turn")).to_be_visible()
    expect(film(looking)).to_be_enabled()
    name, _, ending = download.value.suggested_filename.rpartition(".")
    assert (name, ending in {"mp4", "webm"}) == ("body_turning", True)
    frames = frames_of(download.value)
    assert len(frames) > 4
    assert frames[0].shape == (960, 720, 3)
    turned = [(np.abs(frames[0] - each).max(axis=2) > 40).mean() for each in frames]
    assert max(turned) > 0.02
    # Round again, as far as frames were recorded.
    assert turned[-1] < max(turned)


def test_a_film_leaves_nothing_open(looking: Visitor):
    page = looking.page
    # The film is then one of the skin, whose texture is decoded for it.
    skin = page.locator(".look-beside canvas")
    expect(skin).to_have_attribute("data-shows", "texture", timeout=FIT_WITHIN_MS)
    page.evaluate(COUNT_WHAT_IS_OPEN)
    with page.expect_download(timeout=FIT_WITHIN_MS):
        film(looking).click()
        page.wait_for_function("() => window.open_bitmaps === 1")
    expect(film(looking)).to_be_enabled()
    assert page.evaluate("window.open_bitmaps") == 0
    assert page.evaluate("window.filmed_tracks.map((track) => track.readyState)") == ["ended"]


def test_words_stand_beside_the_icons_where_there_is_room(looking: Visitor):
    words = sharing(looking).get_by_text("Share a short film", exact=True)
    expect(words).to_be_visible()
    expect(film(looking)).to_have_attribute("title", "Share a short film: the body turns once")
    looking.page.set_viewport_size({"width": 390, "height": 844})
    expect(film(looking)).to_be_visible()
    expect(words).to_be_hidden()


def test_a_browser_that_films_nothing_gives_a_picture(looking: Visitor):
    looking.page.evaluate(WITHOUT_RECORDER)
    with looking.page.expect_download() as download:
        film(looking).click()
    assert download.value.suggested_filename == "body_turning.png"
    seen = picture_of(download.value)
    assert seen.shape == (960, 720, 3)
    assert (np.abs(seen - seen[0, 0]).max(axis=2) > VISIBLY).mean() > 0.05


def test_where_there_is_a_sheet_it_is_given_what_was_made(looking: Visitor):
    page = looking.page
    page.evaluate(SHEET)
    pair(looking).click()
    page.wait_for_function("() => window.taken.length === 1")
    assert page.evaluate("window.taken") == ["before_and_after.png image/png"]


def test_a_sheet_that_wants_another_tap_gets_one(looking: Visitor):
    page = looking.page
    page.evaluate(WITHOUT_RECORDER)
    page.evaluate(SHEET)
    page.evaluate("window.refusals = 1")
    film(looking).click()
    again = sharing(looking).get_by_role("button", name="Share it now")
    again.click()
    page.wait_for_function("() => window.taken.length === 1")
    assert page.evaluate("window.taken") == ["body_turning.png image/png"]
    expect(again).to_have_count(0)
