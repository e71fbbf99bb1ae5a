"""Schemathesis, with all its checks, against the running service: API, worker, estimators.

The long run is against a service that asks for keys: its document, read as saying so, has
schemathesis repeat what succeeded without a key and with a wrong one, and expect a refusal. A short
one is against a service that asks for none.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import httpx

from service.api.authentication import OPEN
from service.engine.database import open_database, prepare_database
from service.engine.keys import KeyRing
from service.settings import Settings
from tests.contract.acceptable import ACCEPTED, BY_ID, DERIVATION, FIT, UPLOADED
from tests.contract.document import METHODS
from tests.integration.service.harness import (
    REPOSITORY,
    Machine,
    Service,
    eventually,
    running_service,
)

CONFIG = Path(__file__).with_name("schemathesis.toml")
FEWEST_CASES = 500
FEWEST_CASES_WITHOUT_KEYS = 25

KEYS: dict[str, object] = {"authentication": "keys", "requests_per_minute": 1_000_000}


def test_the_service_is_as_its_document_says_and_answers_nobody_without_a_key(tmp_path: Path):
    key = _new_key(tmp_path)
    with running_service(Machine(tmp_path, settings=KEYS), estimator="real") as service:
        _no_key_opens_nothing(service)
        service.client.headers["Authorization"] = f"Bearer {key}"
        known = _prepare(service)
        document = tmp_path / "openapi.json"
        document.write_text(json.dumps(_with_required_key(service)))
        assert _passed(service, known, tmp_path, str(document)) >= FEWEST_CASES


def test_a_service_without_keys_is_as_its_document_says(tmp_path: Path):
    with running_service(Machine(tmp_path), estimator="real") as service:
        known = _prepare(service)
        address = f"{service.client.base_url}/openapi.json"
        cases = _passed(service, known, tmp_path, address, "--phases", "examples")
        assert cases >= FEWEST_CASES_WITHOUT_KEYS


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
    document = service.client.get("/openapi.json").raise_for_status().json()
    for path, item in document["paths"].items():
        concrete = re.sub(r"\{\w+\}", "0", path)
        for method in item.keys() & set(METHODS):
            for headers in ({}, {"Authorization": "Bearer mq_00000000_wrong"}):
                answer = service.client.request(method, concrete, headers=headers)
                refused = answer.status_code == httpx.codes.UNAUTHORIZED
                assert refused is not path.startswith(OPEN), f"{method} {path}: {answer}"
                assert not refused or answer.headers["WWW-Authenticate"].startswith("Bearer")


def _with_required_key(service: Service) -> dict[str, object]:
    """The document, with the key required as it is here; elsewhere it is optional."""
    document = service.client.get("/openapi.json").raise_for_status().json()
    (scheme, _nobody) = document["security"]
    document["security"] = [scheme]
    for path, item in document["paths"].items():
        for method in item.keys() & set(METHODS):
            if path.startswith(OPEN):
                item[method]["security"] = []
    return document


def _prepare(service: Service) -> dict[str, str]:
    """Have a picture uploaded and fitted, and something derived; returns the variables for it."""
    picture = {"image": ("picture.png", UPLOADED, "image/png")}
    assert service.client.post("/v1/images", files=picture).status_code == 201
    eventually(lambda: _estimates(service), what="an estimator has started")
    patiently = {"Prefer": "wait=60"}
    submission = {"gender": "male", **ACCEPTED, **BY_ID}
    fit = service.client.post("/v1/fits", json=submission, headers=patiently).json()
    derived = service.client.post(
        f"{fit['links']['self']}/derivations", json={"kind": "pose"}, headers=patiently
    ).json()
    assert (fit["state"], derived["state"]) == ("succeeded", "succeeded")
    return {FIT: fit["id"], DERIVATION: derived["id"]}


def _passed(
    service: Service, known: Mapping[str, str], folder: Path, document: str, *options: str
) -> int:
    """Run schemathesis, which is to fail nowhere; returns the number of cases."""
    authorization = service.client.headers.get("Authorization")
    header = ("--header", f"Authorization: {authorization}") if authorization else ()
    done = subprocess.run(
        [
            *(sys.executable, "-m", "schemathesis.cli", "--config-file", str(CONFIG)),
            *("run", document, "--url", str(service.client.base_url), "--checks", "all"),
            *header,
            *options,
        ],
        cwd=folder,  # it keeps a folder of its own where it is started
        env=os.environ | known | {"PYTHONPATH": str(REPOSITORY), "NO_COLOR": "1", "COLUMNS": "100"},
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
