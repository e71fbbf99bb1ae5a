"""Build the image and run it on two hosts: ``python -m tests.image [--mount FROM:TO ...]``.

Needs Linux, root, buildah, debootstrap, iproute2 and a Postgres server's programs, and no container
engine. Prints what it finds, and fails where that is not as it should be.
"""

import argparse
import contextlib
import os
import signal
import time
from collections.abc import Callable, Mapping
from typing import Final

from tests.image import build as contents
from tests.image.build import Image, build_base, build_image, open_image
from tests.image.client import Client, answers, connect
from tests.image.containers import (
    ADDRESSES,
    BACK,
    FRONT,
    POSTGRES_PASSWORD,
    Container,
    entered,
    running,
    running_postgres,
    two_hosts,
)
from tests.object_storage import CREDENTIALS, running_object_storage, variable

PATIENCE_S: Final = 300.0
FITS: Final = 3
URL: Final = f"http://{ADDRESSES[FRONT]}:8000"
WORLDS_FOLDERS: Final = ["/data", "/tmp", "/var/tmp", "/run/lock"]
"""Where the image's user may write if the root file system is not read-only."""


def main() -> None:
    """Build, look, run."""
    parser = argparse.ArgumentParser(prog="python -m tests.image", description=__doc__)
    parser.add_argument(
        "--mount",
        action="append",
        default=[],
        metavar="FROM:TO",
        help="a file or folder that pip needs while the image is built, such as its settings",
    )
    parser.add_argument("--as-built", action="store_true", help="take the image of the last run")
    parsed = parser.parse_args()
    if not parsed.as_built:
        build_base()
        build_image(parsed.mount)
    image = open_image()
    try:
        look_inside(image)
        run_on_two_hosts(image)
    finally:
        image.remove()


def look_inside(image: Image) -> None:
    """Check what is in the image and who may change it."""
    print(f"image: {contents.size_mb(image.root)} MB, user {image.user[0]}:{image.user[1]}")
    print(f"  of it ours: {contents.size_mb(image.root / contents.OURS)} MB")
    expect("no tools of building or developing", contents.tools(image) == [])
    expect("nothing left of the build", contents.remains(image) == [])
    expect("root owns every file and alone may change it", contents.not_sealed(image) == [])
    writable = contents.writable(image)
    print(f"  folders its user may write in: {' '.join(writable)}")
    expect("no others than everybody's and /data", set(writable) <= set(WORLDS_FOLDERS))


def run_on_two_hosts(image: Image) -> None:
    """Run the API on one host and workers on another, and take one worker away."""
    with contextlib.ExitStack() as stack:
        stack.enter_context(two_hosts())
        database_url = stack.enter_context(running_postgres(FRONT))
        with entered(FRONT):
            storage = stack.enter_context(running_object_storage(ADDRESSES[FRONT]))
        settings = {
            "MAQUETTE_DATABASE_URL": database_url,
            "PGPASSWORD": POSTGRES_PASSWORD,
            **dict(map(variable, storage.settings.items())),
            **CREDENTIALS,
            "MAQUETTE_WORKER_PROCESSES": "1",
        }
        api = start(stack, image, settings, FRONT, "api", "serve", "--no-worker")
        stack.enter_context(entered(BACK))
        eventually("the API answers the other host", lambda: answers(URL))
        key = api.execute("maquette", "keys", "create", "somebody").stdout.strip()
        client = connect(URL, key)
        first = start(stack, image, settings, BACK, "worker-1", "worker")
        eventually("the detector proposes points", lambda: client.proposed() > 0)
        fit_first(client, first)
        healthy(api, "maquette", "health")
        healthy(first, "maquette", "health", "--worker")
        look_at_confinement(first)
        second = start(stack, image, settings, BACK, "worker-2", "worker")
        healthy(second, "maquette", "health", "--worker")
        take_one_away(client, first)
        path = client.submit(cues="SE")
        eventually("the other one fits", lambda: running_fits(client, [path]) == 1)
        stop(second, "worker")
        state = client.http.get(path).json()["state"]
        expect(f"its fit is {state}: ended or handed back", state in {"succeeded", "queued"})
        expect("a worker that is gone is not healthy", client.http.get("/healthz/ready").is_error)
        stop(api, "API")


def start(
    stack: contextlib.ExitStack,
    image: Image,
    settings: Mapping[str, str],
    host: str,
    name: str,
    *arguments: str,
) -> Container:
    """Start `maquette` in a container that lives until the stack is left."""
    return stack.enter_context(
        running(image, "maquette", *arguments, host=host, name=name, settings=settings)
    )


def fit_first(client: Client, worker: Container) -> None:
    """Check that the first fit compiles nothing."""
    begun, unpacked = time.monotonic(), worker.kernels()
    result = client.result(client.ended(client.submit(cues="SES")))
    taken = ", ".join(f"{stage} {value:.1f} s" for stage, value in result["stage_seconds"].items())
    print(f"first fit: {time.monotonic() - begun:.1f} s over HTTP; {taken}")
    compiled = worker.kernels() - unpacked
    print(f"kernels: {unpacked} from the image, {compiled} compiled anew")
    expect("the first fit compiles nothing", unpacked > 0 and compiled == 0)


def look_at_confinement(worker: Container) -> None:
    """Check what the processes of a container may do."""
    status = worker.execute("cat", "/proc/1/status").stdout
    fields = dict(line.split(":\t", 1) for line in status.splitlines() if ":\t" in line)
    expect(
        "its first process is maquette",
        "maquette" in worker.execute("cat", "/proc/1/cmdline").stdout,
    )
    expect("not as root", fields["Uid"].split() == [str(worker.image.user[0])] * 4)
    expect("without capabilities", int(fields["CapEff"], 16) == int(fields["CapBnd"], 16) == 0)
    expect("and no way to gain some", fields["NoNewPrivs"] == "1")
    for folder in ("/", "/data", "/opt/maquette", "/usr/local/bin"):
        told = worker.execute("touch", f"{folder}/new").stderr
        expect(f"{folder} is read-only", "Read-only file system" in told)


def take_one_away(client: Client, doomed: Container) -> None:
    """Kill a worker amid its fit; the other one ends it."""
    paths = [client.submit(cues="SE") for _ in range(FITS)]
    eventually("both workers fit", lambda: running_fits(client, paths) == 2)
    doomed.kill()
    jobs = [client.ended(path) for path in paths]
    for job in jobs:
        client.result(job)
    attempts = [job["attempt"] for job in jobs]
    print(f"{FITS} fits, a worker killed amid one: attempts {attempts}")
    expect("the other one takes over", sum(attempts) > FITS)


def running_fits(client: Client, paths: list[str]) -> int:
    """How many of the jobs are being fitted."""
    return [client.http.get(path).json()["state"] for path in paths].count("running")


def stop(container: Container, what: str) -> None:
    """Send SIGTERM to the first process of a container, as an engine does to stop it."""
    begun = time.monotonic()
    os.kill(container.pid, signal.SIGTERM)
    status = container.process.wait(timeout=60.0)
    print(f"{what} told to stop: status {status} after {time.monotonic() - begun:.1f} s")
    expect(f"the {what} stops by itself", status == 0)


def healthy(container: Container, *command: str) -> None:
    """Wait until a health check passes."""
    eventually(" ".join(command), lambda: container.execute(*command).returncode == 0)


def eventually(what: str, condition: Callable[[], bool]) -> None:
    """Wait for a condition, and print that it came."""
    deadline = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < deadline, f"not within {PATIENCE_S} s: {what}"
        time.sleep(0.1)
    print(f"ok: {what}")


def expect(what: str, holds: bool) -> None:
    """Print what holds; end where it does not."""
    assert holds, what
    print(f"ok: {what}")


if __name__ == "__main__":
    main()
