"""Somebody at the page, in Debian's Chromium: what they do there, and what they wait for."""

import contextlib
import io
import json
import re
import shutil
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Frame, Locator, Page, Playwright, Route, expect

from service.demo_data.sample import FOLDER, load_sample

PROGRAMS = ("chromium-headless-shell", "chromium")
"""The shell draws no browser around the page and takes a third of the processor time."""

FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    # WebGL alone: pages are put together faster by the processor than by a graphics card it plays.
    "--disable-gpu-compositing",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)


@contextlib.contextmanager
def chromium(playwright: Playwright) -> Iterator[Browser]:
    """Start the first program there is, with an empty profile; else skip."""
    path = next(filter(None, map(shutil.which, PROGRAMS)), None)
    if path is None:
        pytest.skip("chromium is not installed")
    browser = playwright.chromium.launch(executable_path=path, args=list(FLAGS), headless=True)
    try:
        yield browser
    finally:
        browser.close()


DESK = {"viewport": {"width": 1280, "height": 860}}
PHONE = {
    "viewport": {"width": 390, "height": 844},
    "device_scale_factor": 2,
    "has_touch": True,
    "is_mobile": True,
}
SETTLED = {"reduced_motion": "reduce"}
"""What moves without end is drawn without end, in software: only its own tests let it."""

SAMPLE_SIZE = (720, 960)
SAMPLE_POINTS = json.loads(load_sample().request)["views"][0]["points"]
SAMPLES = {"At ease": "sample", "Upright": "woman", "An arm across": "arm_across"}
STAGE_MARGIN = 16
GIVEN_UP_AFTER_MS = 180_000
"""Guards against hanging, on machines that are busy: what is there is not waited for."""

FIT_WITHIN_MS = 900_000
LOOKS = 500
"""So often what is to change is looked at; each look takes a tenth of a second or more."""

VISIBLY = 12
"""By so many of 255 levels a pixel has changed."""

LIMBS = tuple(
    f"{side}_{joint}"
    for joint in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
    for side in ("left", "right")
)
"""In the order the page asks for them."""

VIOLATIONS = """
window.violations = [];
document.addEventListener("securitypolicyviolation", (event) =>
  window.violations.push(`${event.violatedDirective} ${event.blockedURI}`));
"""

POINT_IS_DRAWN = """([name, x, y, within]) => {
  const moved = document.querySelector(`[data-point="${name}"]`)?.getAttribute("transform") ?? "";
  const found = /translate\\((\\S+) (\\S+)\\)/.exec(moved);
  return found !== null && Math.hypot(found[1] - x, found[2] - y) <= within;
}"""
WIDTH_IS = """([element, least, most]) => {
  const { width } = element.getBoundingClientRect();
  return least <= width && width <= most;
}"""
PICTURE_IS_WHOLE = """(margin) => {
  const [stage, picture] = [".stage", ".stage-picture"].map((each) =>
    document.querySelector(each).getBoundingClientRect());
  const room = Math.min(stage.width - picture.width, stage.height - picture.height);
  return Math.abs(room - 2 * margin) < 1;
}"""
LABELS_ARE_SEEN = """() => {
  const boxOf = (each) => each.getBoundingClientRect();
  const of = (what) => [...document.querySelectorAll(what)].map(boxOf);
  const [beside] = of(".look-beside");
  const labels = of(".tape-label");
  return beside && labels.length > 0 && labels.every(({ bottom, right, top }) =>
    right <= beside.left || bottom <= beside.top || top >= beside.bottom);
}"""
RESULT_IS_SHOWN = """() => {
  const shown = document.querySelector(".bench[data-fit]:has(.body-canvas)");
  return shown !== null && /^#[/]fits[/]/.test(location.hash) &&
    location.hash.endsWith(shown.dataset.fit);
}"""


@dataclass
class Visitor:
    page: Page
    origin: str
    complaints: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    @classmethod
    @contextlib.contextmanager
    def at(
        cls, browser: Browser, address: str, device: dict[str, Any] = DESK, **options: Any
    ) -> Iterator["Visitor"]:
        """Open the page in a profile of its own; at the end nothing may have gone wrong."""
        context = browser.new_context(**(SETTLED | device | options))
        context.set_default_timeout(GIVEN_UP_AFTER_MS)
        context.add_init_script(VIOLATIONS)
        someone = cls(context.new_page(), address.rstrip("/"))
        someone.listen()
        try:
            someone.page.goto(someone.origin + "/")
            # The load event does not await the page's modules.
            someone.page.locator("main").wait_for()
            yield someone
            violations = someone.page.evaluate("window.violations")
            assert violations == [], violations
            assert someone.complaints == [], someone.complaints
            assert someone.strangers() == []
        finally:
            context.close()

    def listen(self) -> None:
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))

    def strangers(self) -> list[str]:
        """Requests that left the service's origin."""
        own = urlsplit(self.origin)
        return [
            url
            for url in self.requests
            if urlsplit(url).scheme not in {"blob", "data"} and urlsplit(url).netloc != own.netloc
        ]

    def open_sample(self, *, name: str = "At ease", with_points: bool = False) -> None:
        """Open a sample, or its picture alone, whose points are then clicked by hand."""
        if with_points:
            self.page.get_by_role("button", name=name).click()
        else:
            picture = FOLDER / f"{SAMPLES[name]}.jpg"
            self.page.get_by_label("Choose a picture").set_input_files(picture)
            self.correct()
            self.page.locator(".panel").get_by_role("button", name="Place points by hand").click()
            expect(self.points()).to_have_count(0)
            self.page.evaluate("scrollTo(0, 0)")
        self.wait_for_stage()

    def correct(self) -> None:
        """Unfold what can be corrected before a fit; the page does so too, where nobody is found.

        Looked and clicked in one turn of the page, or the click could fold what it has unfolded.
        """
        head = self.page.locator(".corrections > summary")
        head.evaluate("head => head.parentElement.open || head.click()")
        self.page.get_by_role("heading", name="Points", exact=True).wait_for()

    def unfold_for_experts(self) -> None:
        """Unfold what experts choose beside the body."""
        fold = self.page.locator(".look-experts")
        if not fold.evaluate("fold => fold.open"):
            fold.locator("> summary").click()

    def wait_for_stage(self) -> None:
        """Wait until the stage takes clicks and lies where it will stay."""
        expect(self.stage).to_have_attribute("aria-busy", "false")
        self.page.evaluate("() => document.fonts.ready.then(() => null)")

    def wait_for_whole_picture(self) -> None:
        """Wait until the picture is as large as the stage allows, whose size has changed."""
        self.page.wait_for_function(PICTURE_IS_WHOLE, arg=STAGE_MARGIN)

    @contextlib.contextmanager
    def without_news(self) -> Iterator[None]:
        """Let the page hear nothing of fits meanwhile, however fast they end."""
        held: list[Route] = []
        holding = True

        def hold(route: Route) -> None:
            if holding and route.request.method == "GET":
                held.append(route)
            else:
                route.continue_()

        paths = re.compile(r"/v1/fits/[0-9a-f-]{36}(/events)?$")
        self.page.route(paths, hold)
        try:
            yield
        finally:
            # Before the rule goes: with the last of its rules the browser lets go what is held.
            holding = False
            for route in held:
                route.continue_()
            self.page.unroute(paths, hold)

    def let_fits_take_minutes(self) -> None:
        """Ask for the paper's search, where the page's own choice ends in a second."""
        self.page.route("**/v1/fits", _by_the_simplex)

    def describe_person(self, height_cm: str = "180.4") -> None:
        self.page.get_by_role("radio", name="Male", exact=True).check()
        self.page.get_by_label("Height", exact=True).fill(height_cm)

    @property
    def stage(self) -> Locator:
        return self.page.locator(".stage")

    def on_stage(self, x: float, y: float) -> tuple[float, float]:
        """Where a pixel of the whole sample lies within the window."""
        box = self.stage.bounding_box()
        assert box is not None
        width, height = SAMPLE_SIZE
        scale = min(
            (box["width"] - 2 * STAGE_MARGIN) / width, (box["height"] - 2 * STAGE_MARGIN) / height
        )
        return (
            box["x"] + (box["width"] - scale * width) / 2 + scale * x,
            box["y"] + (box["height"] - scale * height) / 2 + scale * y,
        )

    def click_points(self, names: Sequence[str] = LIMBS, *, touch: bool = False) -> None:
        """Click points of the sample where its request has them."""
        points = SAMPLE_POINTS
        for name in names:
            at = self.on_stage(points[name]["x"], points[name]["y"])
            if touch:
                self.page.touchscreen.tap(*at)
            else:
                self.page.mouse.click(*at)
        expect(self.points()).to_have_count(len(names))

    def points(self) -> Locator:
        return self.page.locator("[data-point]")

    def place_of(self, name: str) -> tuple[float, float]:
        """Where a point is drawn, within the stage."""
        moved = self.page.locator(f'[data-point="{name}"]').get_attribute("transform")
        assert moved is not None
        x, y = moved.removeprefix("translate(").removesuffix(")").split()
        return float(x), float(y)

    def wait_for_place(
        self, name: str, at: tuple[float, float], *, within_px: float = 1e-6
    ) -> None:
        """Wait until a point is drawn at a spot of the stage."""
        self.page.wait_for_function(POINT_IS_DRAWN, arg=[name, *at, within_px])

    def submit(self) -> None:
        self.page.get_by_role("button", name="Measure", exact=True).click()

    def sent_view(self) -> dict[str, Any]:
        """Submit, and return what was asked of the one picture."""
        (view,) = self.sent_request()["views"]
        return view

    def sent_request(self) -> dict[str, Any]:
        """Submit, and return what was asked of the service."""
        with self.page.expect_request(
            lambda request: request.method == "POST" and request.url.endswith("/v1/fits")
        ) as sent:
            self.submit()
        return sent.value.post_data_json

    def wait_for_result(self, *, look: str = "Body") -> None:
        """Wait until the result is there of the fit that the address names, and look at it so."""
        self.page.wait_for_function(RESULT_IS_SHOWN, timeout=FIT_WITHIN_MS)
        self.choose(look)

    @property
    def body(self) -> Locator:
        return self.page.locator(".body-canvas")

    def wait_until_drawn(
        self, *, placement: str, surface: str = "clay", marked: str = "none"
    ) -> np.ndarray:
        """Wait until the canvas shows this, and return what is seen."""
        shows = f"{placement} {surface} {marked}"
        expect(self.body).to_have_attribute("data-shows", shows)
        return self.pixels(self.body)

    def wait_for_width(self, what: Locator, least: float, most: float = 1e6) -> None:
        """Wait until an element is so wide: neither a wheel's turn nor a key is waited for."""
        self.page.wait_for_function(WIDTH_IS, arg=[what.element_handle(), least, most])

    def pixels(self, what: Locator) -> np.ndarray:
        """What is seen of an element, (h, w, 3)."""
        seen = Image.open(io.BytesIO(what.screenshot())).convert("RGB")
        return np.asarray(seen).astype(np.int16)

    def wait_for_change(self, what: Locator, before: np.ndarray, *, share: float) -> np.ndarray:
        """Wait until this share of an element's pixels looks otherwise, and return what is seen."""
        for _ in range(LOOKS):
            now = self.pixels(what)
            if now.shape != before.shape:
                return now
            if (np.abs(now - before).max(axis=2) > VISIBLY).mean() >= share:
                return now
        message = f"less than {share:.2%} of the pixels changed in {LOOKS} looks"
        raise AssertionError(message)

    def choose(self, name: str) -> None:
        self.page.get_by_role("radio", name=name, exact=True).check()


def _by_the_simplex(route: Route) -> None:
    if route.request.method != "POST":
        route.continue_()
        return
    route.continue_(post_data={**route.request.post_data_json, "optimizer": "simplex"})


def serious_findings(page: Page | Frame, axe: str) -> list[str]:
    """What axe finds of the whole page that keeps somebody from using it."""
    page.evaluate(axe)
    found = page.evaluate("axe.run(document)")
    return [
        f"{finding['id']}: {node['html'][:200]}"
        for finding in found["violations"]
        if finding["impact"] in {"serious", "critical"}
        for node in finding["nodes"]
    ]
