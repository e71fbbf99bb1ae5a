"""A camera that shows a picture, and a phone that is held in some way, for headless Chromium."""

from pathlib import Path
from typing import Final

from playwright.sync_api import BrowserContext, CDPSession, Page

SENSORS: Final = ("accelerometer", "gyroscope", "magnetometer")


def camera_flags(film: Path) -> tuple[str, ...]:
    """Have the camera show these frames; whether a page may see them is for its context to say."""
    return (
        "--use-fake-device-for-media-stream",
        f"--use-file-for-fake-video-capture={film}",
    )


def write_film(film: Path, picture: Path) -> None:
    """Write a film that shows one picture: Motion JPEG is one JPEG after the other."""
    film.write_bytes(10 * picture.read_bytes())


def permit(context: BrowserContext, origin: str) -> None:
    """Let the page use the camera, and tell it how the phone is held."""
    context.grant_permissions(["camera", *SENSORS], origin=origin)


class HeldPhone:
    """How the phone of a page is held, by the angles of the specification.

    The browser gives overridden angles only to pages that are loaded once they are.
    """

    def __init__(self, page: Page) -> None:
        self._session: CDPSession = page.context.new_cdp_session(page)
        self.hold(beta=90.0, gamma=0.0)
        page.reload()

    def hold(self, *, beta: float, gamma: float) -> None:
        """Hold it so."""
        angles = {"alpha": 0.0, "beta": beta, "gamma": gamma}
        self._session.send("DeviceOrientation.setDeviceOrientationOverride", angles)

    def turn_to_landscape(self) -> None:
        """Turn it counterclockwise, whereupon what it shows turns clockwise."""
        screen = {"type": "landscapePrimary", "angle": 90}
        metrics = {"width": 844, "height": 390, "deviceScaleFactor": 2, "mobile": True}
        metrics["screenOrientation"] = screen
        self._session.send("Emulation.setDeviceMetricsOverride", metrics)
