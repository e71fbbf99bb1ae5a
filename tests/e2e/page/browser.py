"""Debian's Chromium without windows, with WebGL in software, asking nobody but the service.

Its headless shell is taken where it is installed. It draws no browser around the page and takes a
third of the processor time (2.2 s for 10 s of a moving page instead of 8.6).
"""

import contextlib
import os
import shutil
from collections.abc import Iterator, Sequence

import pytest
from playwright.sync_api import Browser, Playwright

WHOLE = ("chromium",)
"""Asks whoever is before it, as for a camera; the shell asks nobody and refuses."""

LIGHTEST = ("chromium-headless-shell", *WHOLE)

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
def chromium(
    playwright: Playwright, *flags: str, programs: Sequence[str] = LIGHTEST
) -> Iterator[Browser]:
    """Start the first program there is, with an empty profile and further flags; else skip."""
    path = next(filter(None, map(shutil.which, programs)), None)
    if path is None:
        if os.environ.get("CI"):
            pytest.fail("chromium is not installed")
        pytest.skip("chromium is not installed")
    browser = playwright.chromium.launch(executable_path=path, args=[*FLAGS, *flags], headless=True)
    try:
        yield browser
    finally:
        browser.close()
