"""``maquette demo``: a whole fit over HTTP, from starting the service to the files on disk."""

import argparse
import json
import re
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Final

from api_schemas.client import Maquette, MaquetteError
from service.commands.fit import Stages, add_output, print_result, problem_lines
from service.demo_data.sample import Sample, load_sample
from service.process.supervisor import PYTHON
from service.startup import run_command

SERVE_COMMAND: Final = (*PYTHON, "-m", "service.cli", "serve", "--port", "0")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Folder for the files."""
    add_output(parser, Path("demo-output"))


def run(parsed: argparse.Namespace) -> int:
    """Show the packaged sample."""
    return run_command("demo", lambda _: run_demo(parsed.output, load_sample()))


def run_demo(output: Path, sample: Sample, *, serve_command: Sequence[str] = SERVE_COMMAND) -> int:
    """Start a service, post the sample, follow it, print and keep what comes; return the status."""
    started = time.monotonic()
    output.mkdir(parents=True, exist_ok=True)
    stages = Stages()
    with (
        tempfile.TemporaryDirectory(prefix="maquette-demo-") as data_dir,
        (output / "service.log").open("w") as log,
        running_service(serve_command, Path(data_dir), log) as address,
        Maquette(address) as maquette,
    ):
        print(f"The service listens on {address} ({time.monotonic() - started:.1f} s).")
        try:
            fit = maquette.fit(
                json.loads(sample.request),
                sample.image,
                on_progress=lambda event: stages.show(event.stage, event.progress),
            )
        except MaquetteError as error:
            print("\n".join(problem_lines(error.problem)) if error.problem else error)
            return 1
        for name in fit.links.files:
            file = output / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(maquette.file(fit, name))
        result = maquette.result(fit)
    print_result(result, truth=sample.truth)
    print(
        f"{time.monotonic() - started:.1f} s from start to result. The pictures (overlay.png, "
        "segmentation.png, albedo.png, shading.png ...) and the posed body lie in "
        f"{output}/views/0, the body (body_canonical.glb) and result.json in {output}."
    )
    return 0


@contextmanager
def running_service(command: Sequence[str], data_dir: Path, log: IO[str]) -> Iterator[str]:
    """The address of a service of one's own with its data in a folder."""
    with subprocess.Popen(
        [*command, "--data-dir", str(data_dir)], stdout=subprocess.PIPE, stderr=log, text=True
    ) as process:
        assert process.stdout is not None
        try:
            found = re.search(r"http://\S+:\d+", process.stdout.readline())
            if found is None:
                message = f"The service ended before it listened; {log.name} says why."
                raise SystemExit(message)
            yield found[0]
        finally:
            process.terminate()
