"""A sandbox over HTTP: everything is as everywhere but what jobs do."""

import io
import json
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from uuid import uuid4

import httpx
import pytest
from PIL import Image

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivations import DerivationResult
from api_schemas.results import FitResult
from api_schemas.scans import ScanResult
from service.demo_data.sample import load_sample
from service.jobs.sandbox import (
    BY_ACCIDENT,
    ENDINGS,
    UNUSABLE_FOR_DERIVATIONS,
    UNUSABLE_PICTURES,
    VERDICTS,
    Whose,
)
from tests.e2e.sandbox import (
    derived,
    fitted,
    posted_fit,
    posted_scan,
    result_of,
    running_sandbox,
    scanned,
)
from tests.e2e.service import REPOSITORY, ended_job
from tests.readme import block

SIX_VIEWS = ("front", "side", "back", "side", "other", "side")


@pytest.fixture(scope="module")
def sandbox(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    with running_sandbox(tmp_path_factory.mktemp("sandbox")) as client:
        yield client


@pytest.fixture(scope="module")
def nobody() -> bytes:
    """A picture of one colour, in which no fit finds anybody."""
    encoded = io.BytesIO()
    Image.new("RGB", (720, 960), (90, 120, 150)).save(encoded, "PNG")
    return encoded.getvalue()


@pytest.fixture(scope="module")
def man(sandbox: httpx.Client, nobody: bytes) -> dict[str, Any]:
    return fitted(sandbox, nobody)


@pytest.fixture(scope="module")
def front_and_side(sandbox: httpx.Client, nobody: bytes) -> dict[str, Any]:
    return scanned(sandbox, nobody, views=("front", "side"))


def codes(found: list[dict[str, str]]) -> list[str]:
    return [each["code"] for each in found]


def state_and_code(job: dict[str, Any]) -> tuple[str, str]:
    return job["state"], job["problem"]["code"]


def test_the_index_says_that_it_is_one(sandbox: httpx.Client):
    assert sandbox.get("/").json()["sandbox"] is True


@pytest.mark.parametrize("gender", ["female", "male"])
def test_a_fit_of_any_picture_gives_a_person_of_that_gender(
    sandbox: httpx.Client, nobody: bytes, gender: str
):
    job = fitted(sandbox, nobody, gender=gender)
    document = result_of(sandbox, job)
    result = FitResult.model_validate_json(sandbox.get(job["links"]["result"]).content)
    assert result.gender == gender
    assert len(result.measurements) > 10
    assert codes(document["warnings"])[0] == "sandbox"
    for artifact in result.artifacts:
        content = sandbox.get(job["links"]["artifacts"][artifact.name]).content
        assert len(content) == artifact.size
    assert sandbox.get(job["links"]["image"]).content == nobody
    assert sandbox.get(f"{job['links']['self']}/artifacts/body_posed.obj").status_code == 200


def test_what_is_wrong_with_a_request_is_refused_as_everywhere(
    sandbox: httpx.Client, nobody: bytes
):
    answer = posted_fit(sandbox, nobody, height_m=9.0)
    assert (answer.status_code, answer.json()["field"]) == (422, "height_m")
    assert posted_fit(sandbox, b"no picture").status_code == 415


def test_a_scan_has_the_views_that_were_sent(sandbox: httpx.Client, nobody: bytes):
    job = scanned(sandbox, nobody, views=SIX_VIEWS)
    result = ScanResult.model_validate_json(sandbox.get(job["links"]["result"]).content)
    assert tuple(view.view for view in result.views) == SIX_VIEWS
    assert [view.number for view in result.views] == list(range(6))
    assert result.views[3].body == result.views[1].body != result.views[2].body
    assert "sandbox" in [each.code for each in result.warnings]
    names = {each.name for each in result.artifacts}
    assert {f"{name}_{view}.png" for name in ("overlay", "segmentation") for view in range(6)} < (
        names
    )
    assert sandbox.get(job["links"]["artifacts"]["body_posed_5.glb"]).content[:4] == b"glTF"


WAIST = {"waist_girth_navel": {"low": 70.0, "high": 90.0}}
REQUESTS: dict[DerivationKind, dict[str, Any]] = {
    DerivationKind.CARICATURE: {"factor": 2.5},
    DerivationKind.POSE: {"pose": "arms_raised"},
    DerivationKind.ANIMATION: {},
    DerivationKind.TEXTURE: {},
    DerivationKind.SIZE: {"chart": {"sizes": [{"label": "M", "measurements": WAIST}]}},
    DerivationKind.BODY_COMPOSITION: {"age_years": 40},
}


@pytest.mark.parametrize("kind", DerivationKind)
def test_every_kind_is_derived_from_a_fit(
    sandbox: httpx.Client, man: dict[str, Any], kind: DerivationKind
):
    asked = dict(REQUESTS[kind])
    job = derived(sandbox, man, kind=kind, **asked)
    result = result_of(sandbox, job)
    content = sandbox.get(job["links"]["result"]).content
    assert DerivationResult.model_validate_json(content).root.kind == kind
    files = {each["name"] for each in result["artifacts"]}
    assert files
    assert files == job["links"]["artifacts"].keys() - {"result.json"}
    if kind is DerivationKind.POSE:
        assert sandbox.get(job["links"]["request"]).json()["pose"] == "arms_raised"


@pytest.mark.parametrize("kind", ["pose", "size", "body_composition"])
def test_kinds_are_derived_from_a_scan(
    sandbox: httpx.Client, front_and_side: dict[str, Any], kind: str
):
    job = derived(sandbox, front_and_side, kind=kind, **REQUESTS[DerivationKind(kind)])
    assert result_of(sandbox, job)["kind"] == kind


@pytest.mark.parametrize("ending", [*BY_ACCIDENT, *UNUSABLE_PICTURES])
def test_a_fit_fails_on_request_and_its_retry_does_not(
    sandbox: httpx.Client, nobody: bytes, ending: str
):
    job = fitted(sandbox, nobody, label=f"sandbox:{ending}")
    late = ending == "time-limit-exceeded"
    assert state_and_code(job) == ("timed_out" if late else "failed", ending)
    assert "result" not in {name for name, link in job["links"].items() if link}
    again = ended_job(sandbox, sandbox.post(job["links"]["retry"]))
    assert (again["state"], again["label"]) == ("succeeded", f"sandbox:{ending}")


def test_a_scan_fails_on_request(sandbox: httpx.Client, nobody: bytes):
    job = scanned(sandbox, nobody, views=("front", "side"), label="sandbox:person-not-found")
    assert state_and_code(job) == ("failed", "person-not-found")
    assert job["problem"]["field"] == "views.0.image"


@pytest.mark.parametrize("ending", [*BY_ACCIDENT, *UNUSABLE_FOR_DERIVATIONS])
def test_what_is_derived_fails_on_request(sandbox: httpx.Client, nobody: bytes, ending: str):
    fit = fitted(sandbox, nobody, label=f"sandbox:derivations:{ending}")
    assert fit["state"] == "succeeded"
    job = derived(sandbox, fit, kind="pose", pose="standing")
    assert job["problem"]["code"] == ending


@pytest.mark.parametrize("ending", VERDICTS)
def test_measurements_are_withheld_on_request(sandbox: httpx.Client, nobody: bytes, ending: str):
    fit = result_of(sandbox, fitted(sandbox, nobody, label=f"sandbox:{ending}"))
    label = f"sandbox:{ending}"
    scan = result_of(sandbox, scanned(sandbox, nobody, views=("front", "side"), label=label))
    for result in (fit, scan):
        assert (result["verdict"], result["measurements"]) == (VERDICTS[ending], [])
    assert fit["outcome"] == "poor_fit"


def test_there_are_warnings_on_request(sandbox: httpx.Client, nobody: bytes):
    fit = result_of(sandbox, fitted(sandbox, nobody, label="sandbox:warnings"))
    assert {"sandbox", "low-silhouette-overlap", "segmentation-doubtful"} < set(
        codes(fit["warnings"])
    )


def test_a_slow_job_reports_and_can_be_canceled(sandbox: httpx.Client, nobody: bytes):
    path = posted_fit(sandbox, nobody, label="sandbox:slow:300").headers["Location"]
    with sandbox.stream("GET", f"{path}/events", timeout=600) as events:
        lines = events.iter_lines()
        assert next(line for line in lines if line == "event: progress")
        assert sandbox.get(path).json()["state"] == "running"
        assert sandbox.post(f"{path}/cancel").status_code == 202
        assert next(line for line in lines if line == "event: end")
    assert sandbox.get(path).json()["state"] == "canceled"


def test_a_slow_job_succeeds_in_its_time(sandbox: httpx.Client, nobody: bytes):
    job = fitted(sandbox, nobody, label="sandbox:slow:1")
    events = sandbox.get(job["links"]["events"]).text
    assert job["state"] == "succeeded"
    assert events.count("event: progress") > 3


@pytest.mark.parametrize(
    ("label", "listed"),
    [
        ("sandbox:nonsense", Whose.PICTURES),
        ("sandbox:slow:301", Whose.PICTURES),
        ("sandbox:", Whose.PICTURES),
        ("sandbox:derivations:no-person", Whose.DERIVATIONS),
    ],
)
def test_an_unknown_ending_is_refused_with_those_there_are(
    sandbox: httpx.Client, nobody: bytes, label: str, listed: Whose
):
    before = len(sandbox.get("/v1/fits").json()["jobs"])
    for answer in (
        posted_fit(sandbox, nobody, label=label),
        posted_scan(sandbox, nobody, views=("front", "side"), label=label),
    ):
        problem = answer.json()
        assert (answer.status_code, problem["field"]) == (422, "label")
        assert problem["code"] == "unknown-ending"
        assert all(ending in problem["remedy"] for ending in ENDINGS[listed])
    assert len(sandbox.get("/v1/fits").json()["jobs"]) == before


def test_points_are_those_of_the_sample_in_the_pixels_of_the_picture(sandbox: httpx.Client):
    encoded = io.BytesIO()
    Image.new("RGB", (360, 960)).save(encoded, "PNG")
    narrow = encoded.getvalue()
    sizes = {}
    for name, picture in (("sample", load_sample().image), ("narrow", narrow)):
        answer = sandbox.post(
            "/v1/points", files={"image": ("picture", picture)}, data={"request": '{"mask": true}'}
        )
        if answer.status_code == 404:
            pytest.skip("the detector is not installed")
        sizes[name] = answer.raise_for_status().json()
    assert sizes["narrow"]["image_size"] == {"width": 360, "height": 960}
    whole, half = (sizes[name]["points"]["left_knee"] for name in ("sample", "narrow"))
    assert (half["x"], half["y"]) == (pytest.approx(whole["x"] / 2, abs=0.01), whole["y"])
    checked = sandbox.post(
        "/v1/checks",
        files={"image": ("picture", narrow)},
        data={"request": '{"view": "side"}'},
    )
    assert checked.raise_for_status().json()["usable"] is True


def test_a_key_that_comes_again_gets_the_same_job(sandbox: httpx.Client, nobody: bytes):
    request = load_sample().request
    sent = {
        "files": {"image": ("picture", nobody), "request": ("request", request)},
        "headers": {"Idempotency-Key": str(uuid4()), "Prefer": "wait=60"},
    }
    first, second = (sandbox.post("/v1/fits", **sent).json() for _ in range(2))
    assert first["id"] == second["id"]
    assert first["state"] == "succeeded"


def test_the_examples_of_its_page_run(sandbox: httpx.Client, man: dict[str, Any], tmp_path: Path):
    # Its worker has loaded what jobs wait for.
    assert man["state"] == "succeeded"
    (tmp_path / "service").symlink_to(REPOSITORY / "service")
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", block("sandbox") + block("sandbox endings")],
        cwd=tmp_path,
        env=os.environ | {"SERVICE": str(sandbox.base_url)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert json.loads((tmp_path / "result.json").read_text())["gender"] == "female"
    assert (tmp_path / "body.glb").read_bytes()[:4] == b"glTF"
    assert '"code":"person-not-found"' in done.stdout
    assert done.stdout.count("event: progress") > 3
    assert done.stdout.count("event: end") == 1
