"""The documents' examples: the body over its picture by trimesh and by three.js, a turntable."""

import contextlib
import functools
import http.server
import io
import os
import runpy
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image
from playwright.sync_api import Page, sync_playwright

from fitter.body.storage import packaged_model_path
from fitter.fits.equipment import prepared_model
from fitter.person.fitted_person import FittedPerson
from fitter.render.rasterizer import render
from fitter.vocabulary.choices import Gender
from service.demo_data.sample import FOLDER
from tests.e2e.page.visitor import chromium
from tests.integration.service.harness import eventually
from tests.readme import block

MAGENTA = (255, 0, 255)
"""No body is of this colour."""


@pytest.fixture
def folder(files: Path, tmp_path: Path) -> Path:
    """What the README's commands leave, and the sample where they expect it."""
    for name in ("views/0/body_posed.glb", "result.json"):
        shutil.copy(files / "sample" / name, tmp_path)
    (tmp_path / "service" / "demo_data").mkdir(parents=True)
    shutil.copy(FOLDER / "sample.jpg", tmp_path / "service" / "demo_data")
    return tmp_path


def test_trimesh_draws_the_body_where_the_picture_has_it(files: Path, folder: Path):
    done = subprocess.run(
        [sys.executable, "-c", block("trimesh")],
        cwd=folder,
        env=os.environ | {"PYTHONWARNINGS": "default"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    drawn = np.asarray(Image.open(folder / "drawn.png"))
    sample = np.asarray(Image.open(FOLDER / "sample.jpg").convert("RGB"))
    check((drawn != sample).any(axis=2), files)


def test_numpy_makes_the_body_of_the_person_alone(files: Path, folder: Path, monkeypatch):
    """The lines that the page shows, and the exported mesh in the camera's axes."""
    monkeypatch.chdir(folder)
    shutil.copy(files / "sample" / "person.npz", folder)
    for gender in Gender:
        shutil.copy(packaged_model_path(gender), folder)
    page = Path(__file__).parents[2] / "service" / "docs" / "guide" / "results.md"
    assert "```{literalinclude} read_person.py" in page.read_text()
    made = runpy.run_path(str(page.with_name("read_person.py")))["vertices"]
    scene = trimesh.load_scene("body_posed.glb", process=False)
    body = scene.to_mesh().apply_transform(np.linalg.inv(scene.graph.get("upright")[0]))
    np.testing.assert_allclose(made, body.vertices * [1, -1, -1], atol=1e-4)


def test_three_js_draws_the_body_where_the_picture_has_it(
    files: Path, folder: Path, npm_readers: Path
):
    (folder / "index.html").write_text(block("three"))
    shutil.copy(FOLDER / "sample.jpg", folder)
    (folder / "three").symlink_to(npm_readers / "node_modules" / "three")
    with drawn_page(folder, width=720, height=960) as page:
        # What shows through is not the body.
        page.add_style_tag(content="img { visibility: hidden } body { background: #f0f }")
        drawn = seen(page)
    check((drawn != MAGENTA).any(axis=2), files)


def test_the_turntable_shows_the_textured_body_turning(
    files: Path, tmp_path: Path, npm_readers: Path
):
    (tmp_path / "index.html").write_text(block("turntable"))
    shutil.copy(files / "texture" / "body_textured.glb", tmp_path)
    (tmp_path / "three").symlink_to(npm_readers / "node_modules" / "three")
    with drawn_page(tmp_path, width=240, height=320) as page:
        eventually(lambda: 0.05 < share_drawn(seen(page)) < 0.5, what="the body is drawn")
        before = seen(page)
        eventually(lambda: (seen(page) != before).any(), what="it turns")


def check(drawn: np.ndarray, files: Path) -> None:
    """Compare with where our own rasteriser has the body, and with where the person was found."""
    fitted = FittedPerson.from_bytes((files / "sample" / "person.npz").read_bytes())
    evaluator = prepared_model(fitted.gender, models=None).operators.evaluator
    body = evaluator.vertices(fitted.body)
    own = render(body, evaluator.model.triangles, fitted.camera).silhouette
    person = (
        np.asarray(Image.open(files / "sample" / "views" / "0" / "segmentation.png").convert("L"))
        > 127
    )
    assert drawn.shape == own.shape == person.shape
    assert overlap(drawn, own) > 0.98
    assert overlap(drawn, person) > 0.93


def overlap(one: np.ndarray, other: np.ndarray) -> float:
    return (one & other).sum() / (one | other).sum()


def seen(page: Page) -> np.ndarray:
    """What a page shows, (h, w, 3) levels."""
    return np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB"), dtype=int)


def share_drawn(levels: np.ndarray) -> float:
    """Which share of a picture does not look like its corner."""
    return float((np.abs(levels - levels[0, 0]).max(axis=2) > 16).mean())


@contextlib.contextmanager
def drawn_page(folder: Path, *, width: int, height: int) -> Iterator[Page]:
    """A folder's page in Chromium once it has a canvas; no script of it may fail."""
    faults: list[str] = []
    with (
        served(folder) as address,
        sync_playwright() as playwright,
        chromium(playwright) as browser,
    ):
        page = browser.new_page(viewport={"width": width, "height": height})
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.goto(address)
        page.wait_for_selector("canvas", timeout=120_000)
        yield page
    assert faults == []


@contextlib.contextmanager
def served(folder: Path) -> Iterator[str]:
    handler = functools.partial(Quiet, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}/index.html"
        finally:
            server.shutdown()
            thread.join()


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Nobody reads it."""
