"""Schemathesis, with all its checks, against the running service: API, worker, estimators."""

import os
import re
import subprocess
import sys
from pathlib import Path

from tests.contract.acceptable import UPLOADED
from tests.integration.service.harness import (
    REPOSITORY,
    Machine,
    Service,
    eventually,
    running_service,
)

CONFIG = Path(__file__).with_name("schemathesis.toml")
FEWEST_CASES = 500


def test_the_service_is_as_its_document_says(tmp_path: Path):
    with running_service(Machine(tmp_path), estimator="real") as service:
        picture = {"image": ("picture.png", UPLOADED, "image/png")}
        assert service.client.post("/v1/images", files=picture).status_code == 201
        eventually(lambda: _estimates(service), what="an estimator has started")
        done = subprocess.run(
            [
                *(sys.executable, "-m", "schemathesis.cli", "--config-file", str(CONFIG)),
                *("run", f"{service.client.base_url}/openapi.json", "--checks", "all"),
            ],
            cwd=tmp_path,  # it keeps a folder of its own where it is started
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
    assert int(cases[1].replace(",", "")) >= FEWEST_CASES


def _estimates(service: Service) -> bool:
    return service.client.post("/v1/bodies", json={"gender": "female"}).status_code == 200


def _summary(output: str) -> str:
    return output[output.find("SUMMARY") :]
