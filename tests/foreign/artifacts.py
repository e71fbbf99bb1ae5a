"""Every mesh file that leaves the service: of a fit of two pictures, and of what is made of it.

And of a fit of the sample alone, which the documents' examples draw.

Made once for all tests of a run, by the pipeline that the workers run, and kept as files, because
that is what foreign readers open.
"""

import fcntl
import json
from collections.abc import Iterator, Mapping
from pathlib import Path

from api_schemas.fit import FitRequest
from service.compute.pipeline import fit_task, product_task
from service.compute.tasks import OPTIONS, ChildSetup
from service.demo_data.sample import FOLDER, load_sample
from service.jobs.inputs import SentPicture, named_pictures, product_inputs
from service.submissions.submission import check_submission

MAX_PIXELS = 2_000_000
SETUP = ChildSetup(name="job", max_pixels=MAX_PIXELS)

PRODUCTS: Mapping[str, dict[str, object]] = {
    "texture": {"kind": "texture", "colours": "picture", "size": 512},
    "albedo_texture": {"kind": "texture", "colours": "albedo", "size": 512},
    "pose": {"kind": "pose", "pose": "t_pose"},
    "animation": {"kind": "animation"},
    "caricature": {"kind": "caricature", "factor": 1.5},
}
"""What makes meshes of the fit, by the name of the folder its files are put in."""

GLB_FILES = (
    "fit/body_canonical.glb",
    "fit/views/0/body_posed.glb",
    "fit/views/1/body_posed.glb",
    "texture/body_textured.glb",
    "albedo_texture/body_textured.glb",
    "pose/body_reposed.glb",
    "animation/body_animated.glb",
    "animation/body_skinned.glb",
    "caricature/body_caricature.glb",
)


def made_in(folder: Path) -> Path:
    """Make all files below the folder unless another process did, and return where they lie."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        stamp = folder / "complete"
        if not stamp.exists():
            for name, files in _made():
                for each, content in files.items():
                    file = folder / name / each
                    file.parent.mkdir(parents=True, exist_ok=True)
                    file.write_bytes(content)
            stamp.touch()
    return folder


def _made() -> Iterator[tuple[str, Mapping[str, bytes]]]:
    sample = load_sample()
    front, side = ((FOLDER / f"{view}.jpg").read_bytes() for view in ("front", "side"))
    fit = _of_fit((FOLDER / "front_and_side.json").read_bytes(), front, side)
    yield "fit", fit
    yield from _products(PRODUCTS, fit)
    yield "sample", _of_fit(sample.request, sample.image)


def _of_fit(request: bytes, *images: bytes) -> dict[str, bytes]:
    """A fit's files, and its pictures."""
    pictures = tuple(SentPicture(image, None) for image in images)
    asked = FitRequest.model_validate_json(request)
    checked = check_submission(asked, pictures, max_pixels=MAX_PIXELS)
    options = checked.request.model_dump_json().encode()
    files = named_pictures(pictures)
    return {**fit_task(SETUP, {OPTIONS: options, **files}, lambda _: None), **files}


def _products(
    asked_of: Mapping[str, dict[str, object]], there: Mapping[str, bytes]
) -> Iterator[tuple[str, Mapping[str, bytes]]]:
    for name, asked in asked_of.items():
        parts = {OPTIONS: json.dumps(asked).encode(), **product_inputs(there)}
        yield name, product_task(SETUP, parts, lambda _: None)
