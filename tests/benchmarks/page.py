"""The page in a browser on the loopback: from the address to the first point, and its weight."""

import json
import os
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

import httpx
from playwright.sync_api import Browser, sync_playwright

from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks.spent import late, median
from tests.e2e.page.browser import WHOLE, chromium
from tests.e2e.page.visitor import LIMBS, Visitor
from tests.e2e.service import running_service, wait_for_estimator

_QUIET = {"MAQUETTE_LOG_LEVEL": "WARNING"}

MOMENTS = {
    "something to click": ".samples button",
    "the picture can be clicked": ".stage-picture",
    "the first click is a point": "[data-point]",
}
"""When the first element of each kind is there; the clicks between them are made at once."""

_WATCH = """
(moments) => {
  window.moments = {};
  const look = () => {
    for (const [name, selector] of Object.entries(moments))
      if (!(name in window.moments) && document.querySelector(selector))
        window.moments[name] = performance.now();
  };
  new MutationObserver(look).observe(document, { childList: true, subtree: true });
}
"""


def lines(count: int) -> Iterator[str]:
    """``count`` visits, each with an empty cache, milliseconds since navigation began."""
    os.environ.update(_QUIET)
    with (
        tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder,
        running_service(Path(folder)) as client,
        sync_playwright() as playwright,
        chromium(playwright, programs=WHOLE) as browser,
    ):
        wait_for_estimator(client)
        visits = [_visit(browser, str(client.base_url)) for _ in range(count + 1)][1:]
        weights = _weights(client)
    rows = [
        (name, f"{median(values):.0f}", f"{late(values):.0f}")
        for name in MOMENTS
        if (values := [visit[name] for visit in visits])
    ]
    yield from table_lines(
        f"{count} first visits in Chromium on loopback, ms since navigation began",
        ("", "median", "95 %"),
        rows,
    )
    yield from note_lines(
        f"As served, compressed: {sum(weights.values()) / 1e3:.0f} kB in all, of which the 3D view "
        f"({weights['BodyScene'] / 1e3:.0f} kB) is fetched with the first result."
    )


def _visit(browser: Browser, address: str) -> dict[str, float]:
    with Visitor.at(browser, address) as visitor:
        # Once more with a watch, its cache emptied by a profile of its own.
        page = visitor.page
        page.context.add_init_script(f"({_WATCH})({json.dumps(MOMENTS)})")
        session = page.context.new_cdp_session(page)
        session.send("Network.clearBrowserCache")
        page.goto(address, wait_until="commit")
        visitor.open_sample()
        visitor.click_points(LIMBS[:1])
        return page.evaluate("window.moments")


def _weights(client: httpx.Client) -> dict[str, int]:
    """Bytes that go over the wire, by the file's name up to its hash; licences are not loaded."""
    index = client.get("/", headers={"Accept": "text/html"})
    found = {"index": index.num_bytes_downloaded}
    names = set(re.findall(r'/page/([^"]+)', index.text))
    script = next(name for name in names if name.startswith("page."))
    names |= set(re.findall(r"BodyScene\.\w+\.js", client.get(f"/page/{script}").text))
    for name in names:
        found[name.partition(".")[0]] = client.get(f"/page/{name}").num_bytes_downloaded
    return found
