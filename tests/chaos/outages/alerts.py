"""A Prometheus of the run's own, with the rules operators get: which alerts fire?"""

import contextlib
import json
import shutil
import socket
import subprocess
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

import httpx

RULES = Path(__file__).parents[3] / "service" / "docs" / "operate" / "alerts.yaml"
STEP_S = 5


class Watch:
    """Asks which alerts were pending or firing since the start."""

    def __init__(self, address: str | None) -> None:
        self._address = address
        self._began = time.time()

    def seen(self) -> Mapping[str, float] | None:
        """Seconds for each ``alert state``; None without a Prometheus on this machine."""
        if self._address is None:
            return None
        asked = {"query": "ALERTS", "start": self._began, "end": time.time(), "step": STEP_S}
        answer = httpx.get(f"{self._address}/api/v1/query_range", params=asked).raise_for_status()
        lasted: defaultdict[str, float] = defaultdict(float)
        for series in answer.json()["data"]["result"]:
            labels = series["metric"]
            lasted[f"{labels['alertname']} {labels['alertstate']}"] += STEP_S * len(
                series["values"]
            )
        return dict(lasted)


@contextlib.contextmanager
def watching(service_address: str) -> Iterator[Watch]:
    """Scrape the service while the context lasts."""
    program = shutil.which("prometheus")
    if program is None:
        yield Watch(None)
        return
    folder = Path(tempfile.mkdtemp(prefix="maquette-prometheus-"))
    target = service_address.removeprefix("http://")
    configuration = {
        "global": {"scrape_interval": f"{STEP_S}s", "evaluation_interval": f"{STEP_S}s"},
        "rule_files": [str(RULES)],
        "scrape_configs": [{"job_name": "maquette", "static_configs": [{"targets": [target]}]}],
    }
    # JSON is YAML.
    (folder / "prometheus.yaml").write_text(json.dumps(configuration))
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        listening = f"127.0.0.1:{listener.getsockname()[1]}"
    process = subprocess.Popen(
        [
            program,
            f"--config.file={folder / 'prometheus.yaml'}",
            f"--storage.tsdb.path={folder / 'data'}",
            f"--web.listen-address={listening}",
        ],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield Watch(f"http://{listening}")
    finally:
        process.kill()
        process.wait()
        shutil.rmtree(folder)
