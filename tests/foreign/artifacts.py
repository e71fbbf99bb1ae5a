"""Every mesh file that leaves the service: of a fit, of a scan, and of all that derives meshes.

Made once for all tests of a run, by the pipeline that the workers run, and kept as files, because
that is what foreign readers open.
"""

import fcntl
import json
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from api_schemas.derivations import DerivationRequest
from api_schemas.scans import ScanRequest
from service.api.derivation_kinds import needs_of
from service.demo_data.sample import load_sample, load_scan_sample
from service.jobs.inputs import (
    IMAGE,
    OF_FIRST_VIEW,
    REQUEST,
    SentPicture,
    image_of,
)
from service.submissions.submission import check_fit, check_submission
from service.worker.artifacts import with_result_document
from service.worker.pipeline import derive, run
from service.worker.pipeline_port import (
    DerivationInput,
    PipelineInput,
)

MAX_PIXELS = 2_000_000

DERIVED: Mapping[str, dict[str, object]] = {
    "texture": {"kind": "texture", "colours": "picture", "size": 512},
    "albedo_texture": {"kind": "texture", "colours": "albedo", "size": 512},
    "pose": {"kind": "pose", "pose": "t_pose"},
    "animation": {"kind": "animation"},
    "caricature": {"kind": "caricature", "factor": 1.5},
}
"""What makes meshes of the fit, by the name of the folder its files are put in."""

DERIVED_OF_SCAN: Mapping[str, dict[str, object]] = {
    f"scan_{name}": DERIVED[name]
    for name in ("texture", "albedo_texture", "pose", "animation", "caricature")
}
"""The same of the scan."""

GLB_FILES = (
    "fit/body_canonical.glb",
    "fit/body_canonical_se.glb",
    "fit/body_posed.glb",
    "fit/body_posed_se.glb",
    "texture/body_textured.glb",
    "albedo_texture/body_textured.glb",
    "pose/body_reposed.glb",
    "animation/body_animated.glb",
    "animation/body_skinned.glb",
    "caricature/body_caricature.glb",
    "scan/body_canonical.glb",
    "scan/body_canonical_se.glb",
    "scan/body_posed_0.glb",
    "scan/body_posed_1.glb",
    "scan/body_posed_se_0.glb",
    "scan/body_posed_se_1.glb",
    "scan_texture/body_textured.glb",
    "scan_albedo_texture/body_textured.glb",
    "scan_pose/body_reposed.glb",
    "scan_animation/body_animated.glb",
    "scan_animation/body_skinned.glb",
    "scan_caricature/body_caricature.glb",
)


def made_in(folder: Path) -> Path:
    """Make all files below the folder unless another process did, and return where they lie."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        stamp = folder / "complete"
        if not stamp.exists():
            for name, files in _made():
                (folder / name).mkdir(exist_ok=True)
                for each, content in files.items():
                    (folder / name / each).write_bytes(content)
            stamp.touch()
    return folder


def _made() -> Iterator[tuple[str, Mapping[str, bytes]]]:
    fit = _of_fit()
    yield "fit", fit
    yield from _derived(DERIVED, fit)
    scanned = _of_scan()
    yield "scan", scanned
    first = {
        name: scanned[of_view] for name, of_view in OF_FIRST_VIEW.items() if of_view in scanned
    }
    yield from _derived(DERIVED_OF_SCAN, scanned | first)


def _of_fit() -> dict[str, bytes]:
    """A fit's files, its picture and its request."""
    sample = load_sample()
    options = check_fit(
        request=sample.request, image=sample.image, mask=None, max_pixels=MAX_PIXELS
    ).options
    output = run(
        PipelineInput(
            options=options, pictures=(SentPicture(sample.image, None),), max_pixels=MAX_PIXELS
        ),
        lambda _: None,
    )
    files = dict(with_result_document(output.result, output.artifacts))
    return files | {IMAGE: sample.image, REQUEST: options.model_dump_json().encode()}


def _of_scan() -> dict[str, bytes]:
    """A scan's files, its pictures and its request."""
    sample = load_scan_sample()
    pictures = tuple(SentPicture(image, None) for image in sample.images)
    checked = check_submission(
        ScanRequest.model_validate_json(sample.request), pictures, max_pixels=MAX_PIXELS
    )
    output = run(
        PipelineInput(options=checked.options, pictures=pictures, max_pixels=MAX_PIXELS),
        lambda _: None,
    )
    files = dict(with_result_document(output.result, output.artifacts))
    images = {image_of(number): image for number, image in enumerate(sample.images)}
    return files | images | {REQUEST: checked.options.model_dump_json().encode()}


def _derived(
    asked_of: Mapping[str, dict[str, object]], there: Mapping[str, bytes]
) -> Iterator[tuple[str, Mapping[str, bytes]]]:
    for name, asked in asked_of.items():
        request = DerivationRequest.model_validate_json(json.dumps(asked))
        needs = needs_of(request.root)
        made = derive(
            DerivationInput(
                options=request.root,
                inputs=_copies(there, needs.of_fit),
                max_pixels=MAX_PIXELS,
            ),
            lambda _: None,
        )
        yield name, with_result_document(made.result, made.artifacts)


def _copies(there: Mapping[str, bytes], names: Collection[str]) -> dict[str, bytes]:
    return {each: there[each] for each in names if each in there}
