"""The service is as its document says: by schemathesis with all its checks, and by examples.

The service asks for keys: its document, read as saying so, has schemathesis repeat what succeeded
without a key and with a wrong one, and expect a refusal. ``CONTRACT_EXAMPLES=10`` sends so many
random cases for each operation in place of the few of every run.
"""

import copy
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from service.api.auth import OPEN
from service.api.openapi import recorded_examples
from service.jobs.database import open_database, prepare_database
from service.jobs.keys import KeyRing
from service.settings import Settings
from tests.contract.acceptable import ACCEPTED, UPLOADED
from tests.contract.document import METHODS, Document, media_types, operations, whole
from tests.contract.recording import differences, recorded_from_service
from tests.integration.service.harness import (
    REPOSITORY,
    Machine,
    Service,
    eventually,
    running_service,
)

pytestmark = pytest.mark.slow

CONFIG = Path(__file__).with_name("schemathesis.toml")
FEWEST_CASES = 700
EXAMPLES = os.environ.get("CONTRACT_EXAMPLES", "1")
"""Random cases of each operation, and of ways from one to the next."""

KEYS: dict[str, object] = {"authentication": "keys", "requests_per_minute": 1_000_000}


def test_the_service_is_as_its_document_says_and_answers_nobody_without_a_key(tmp_path: Path):
    key = _new_key(tmp_path)
    with running_service(Machine(tmp_path, settings=KEYS), estimator="real") as service:
        _no_key_opens_nothing(service)
        service.client.headers["Authorization"] = f"Bearer {key}"
        _prepare(service)
        document = _with_required_key(_document(service))
        assert _passed(service, tmp_path, document) >= FEWEST_CASES


def _new_key(data_dir: Path) -> str:
    url = Settings(data_dir=data_dir).system_database_url
    prepare_database(url)
    database = open_database(url, connections=1)
    try:
        return KeyRing(database).create("contract")
    finally:
        database.dispose()


def _no_key_opens_nothing(service: Service) -> None:
    """Every operation that is not for everybody answers 401, whatever else is sent to it."""
    for path, item in _document(service)["paths"].items():
        concrete = re.sub(r"\{\w+\}", "0", path)
        for method in item.keys() & set(METHODS):
            for headers in ({}, {"Authorization": "Bearer mq_00000000_wrong"}):
                answer = service.client.request(method, concrete, headers=headers)
                refused = answer.status_code == httpx.codes.UNAUTHORIZED
                assert refused is not path.startswith(OPEN), f"{method} {path}: {answer}"
                assert not refused or answer.headers["WWW-Authenticate"].startswith("Bearer")


def _document(service: Service) -> Document:
    """The document, with streams described as schemathesis reads them: as OpenAPI 3.2 has it."""
    document = whole(service.client.get("/openapi.json").raise_for_status().json())
    for operation in operations(document):
        for where, content in media_types(operation):
            if where.endswith("text/event-stream"):
                content["itemSchema"] = content.pop("schema")["contentSchema"]["items"]
    return document


def _with_required_key(document: Document) -> Document:
    """The document, with the key required as it is here; elsewhere it is optional."""
    (scheme, _nobody) = document["security"]
    document["security"] = [scheme]
    for path, item in document["paths"].items():
        for method in item.keys() & set(METHODS):
            if path.startswith(OPEN):
                item[method]["security"] = []
    return document


def _prepare(service: Service) -> None:
    """Have a picture uploaded and fitted."""
    picture = {"image": ("picture.png", UPLOADED, "image/png")}
    assert service.client.post("/v1/images", files=picture).status_code == 201
    eventually(lambda: _estimates(service), what="an estimator has started")
    accepted = service.client.post("/v1/fits", json={"gender": "male", **ACCEPTED})
    fit = service.ended(accepted.raise_for_status().headers["Location"])
    assert fit["state"] == "succeeded"


def _passed(service: Service, folder: Path, document: Document) -> int:
    """Run schemathesis, which is to fail nowhere; returns the number of cases."""
    (folder / "openapi.json").write_text(json.dumps(document))
    done = subprocess.run(
        [
            *(sys.executable, "-m", "schemathesis.cli", "--config-file", str(CONFIG)),
            *("run", "openapi.json", "--url", str(service.client.base_url), "--checks", "all"),
            *("--max-examples", EXAMPLES),
            *("--header", f"Authorization: {service.client.headers['Authorization']}"),
        ],
        cwd=folder,  # it keeps a folder of its own where it is started
        env=os.environ | {"PYTHONPATH": str(REPOSITORY), "NO_COLOR": "1", "COLUMNS": "100"},
        capture_output=True,
        text=True,
        check=False,
    )
    print(_summary(done.stdout))
    assert done.returncode == 0, done.stdout + done.stderr
    cases = re.search(r"([\d,]+) generated, ([\d,]+) passed", done.stdout)
    assert cases is not None, done.stdout
    assert cases[1] == cases[2]
    return int(cases[1].replace(",", ""))


def _estimates(service: Service) -> bool:
    return service.client.post("/v1/bodies", json={"gender": "female"}).status_code == 200


def _summary(output: str) -> str:
    return output[output.find("SUMMARY") :]


def test_the_examples_are_what_a_service_answers(tmp_path: Path):
    recorded = recorded_from_service(tmp_path)
    assert differences(recorded, recorded_examples()) == [], "run `make examples openapi`"


def test_an_example_that_is_no_answer_would_be_noticed():
    shown = recorded_examples()
    other = copy.deepcopy(dict(shown))
    fit = other["answers"]["get_fit"]["200"]
    fit["succeeded"]["state"] = "failed"
    del fit["running"]["label"]
    other["answers"]["list_fits"]["200"]["first-page"]["fits"].clear()
    assert len(differences(json.loads(json.dumps(other)), shown)) == 3
