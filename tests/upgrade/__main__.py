"""``python -m tests.upgrade REVISION``: from a released version to the work tree, and back.

Real fits and scans are submitted all the while, on Postgres (a database of its own on
127.0.0.1:5432), as service/docs/operate/release.md has it. Where the tables are others, the new
version must say so and change nothing. Exits with 1 if a request was refused, a job was lost or
ended otherwise.
"""

import argparse
import shutil
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import httpx

from tests.chaos.caller import Caller
from tests.chaos.reference import Outcome, outcome
from tests.installation import Installation
from tests.postgres import fresh_database
from tests.submissions import scan_files, small_submissions
from tests.upgrade.site import Site, running_site
from tests.upgrade.versions import following, released, version_of

PICTURES = 4
OTHER_TABLES = 78
PACE_S = 1.5
EACH_STEP_S = 6.0
ENDED_WITHIN_S = 300.0

Step = tuple[str, Callable[[], object]]
"""What is done, and how it is called."""


@dataclass
class Traffic:
    """Fits and scans that are submitted one after the other until it is enough."""

    site: Site
    paths: list[tuple[int, str]] = field(default_factory=list[tuple[int, str]])
    refused: list[str] = field(default_factory=list[str])
    is_enough: bool = False

    def flow(self) -> None:
        """Submit, without asking again where that fails; an answer must always come."""
        pictures = small_submissions(PICTURES)
        forms = [("/v1/fits", each.files) for each in pictures]
        forms.append(("/v1/scans", scan_files(pictures[0])))
        while not self.is_enough:
            which = len(self.paths) % len(forms)
            path, files = forms[which]
            try:
                answer = httpx.post(f"{self.site.address}{path}", files=files, timeout=60.0)
            except httpx.TransportError as error:
                self.refused.append(repr(error))
                continue
            if answer.status_code == httpx.codes.ACCEPTED:
                self.paths.append((which, answer.headers["Location"]))
            else:
                self.refused.append(answer.text)
            time.sleep(PACE_S)

    def run_out(self) -> None:
        """Wait until all that is accepted by now has ended."""
        caller = Caller(self.site.address)
        try:
            for _, path in list(self.paths):
                caller.ended(path, within_s=ENDED_WITHIN_S)
        finally:
            caller.close()


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tests.upgrade", description=__doc__)
    parser.add_argument("revision", help="commit or tag of the released version")
    revision = parser.parse_args(arguments).revision
    folder = Path(tempfile.mkdtemp(prefix="maquette-upgrade-"))
    old, new = released(revision, folder / "old"), following(folder / "new")
    print(f"from {version_of(old)} to {version_of(new)}", flush=True)
    with fresh_database() as database_url, running_site(folder / "site", database_url) as site:
        status = _there_and_back(site, old, new)
    if status:
        print(f"FAULTS: data and log are kept in {folder}", flush=True)
    else:
        shutil.rmtree(folder)
    return status


def _there_and_back(site: Site, old: Installation, new: Installation) -> int:
    assert site.prepare(old).returncode == 0
    site.start_api(old)
    site.start_worker(old)
    asked = site.prepare(new)
    if asked.returncode == OTHER_TABLES:
        print(f"other tables, and nothing is changed: {asked.stderr.strip()}")
        return 0
    assert asked.returncode == 0, asked.stderr
    traffic = Traffic(site)

    def workers(what: str, version: Installation) -> list[Step]:
        return [
            (f"{what}: another worker", partial(site.start_worker, version)),
            (f"{what}: the worker before it stops", site.stop_oldest_worker),
        ]

    def api(what: str, version: Installation) -> list[Step]:
        return [
            (f"{what}: another API process", partial(site.start_api, version)),
            (f"{what}: the one before it stops", site.stop_oldest_api),
        ]

    steps = workers("upgrade", new) + api("upgrade", new)
    # Workers of an older version may not see the jobs of a newer API.
    steps += [*api("roll back", old), ("roll back: its jobs run out", traffic.run_out)]
    return _judge(site, traffic, steps + workers("roll back", old))


def _judge(site: Site, traffic: Traffic, steps: Sequence[Step]) -> int:
    flowing = threading.Thread(target=traffic.flow)
    flowing.start()
    try:
        for what, step in steps:
            began, accepted = time.monotonic(), len(traffic.paths)
            step()
            time.sleep(EACH_STEP_S)
            took_s = time.monotonic() - began - EACH_STEP_S
            print(f"{what:40} {took_s:5.1f} s, {len(traffic.paths) - accepted} fits", flush=True)
    finally:
        traffic.is_enough = True
        flowing.join()
    caller = Caller(site.address)
    try:
        jobs = [
            (which, caller.ended(path, within_s=ENDED_WITHIN_S)) for which, path in traffic.paths
        ]
        succeeded = [
            (which, outcome(caller, job))
            for which, job in jobs
            if job is not None and job["state"] == "succeeded"
        ]
    finally:
        caller.close()
    for which, job in jobs:
        if job is None or job["state"] != "succeeded":
            print(f"picture {which}: {'did not end' if job is None else job}")
    others = sum(not found.agrees_with(_first(succeeded, which)) for which, found in succeeded)
    again = sum(job["attempt"] - 1 for _, job in jobs if job is not None)
    print(f"fits accepted {len(jobs)}, succeeded {len(succeeded)}, run again {again}")
    print(f"requests refused {len(traffic.refused)} {traffic.refused[:3]}")
    print(f"results that differ between versions {others}")
    return int(len(succeeded) < len(jobs) or bool(traffic.refused))


def _first(outcomes: Sequence[tuple[int, Outcome]], which: int) -> Outcome:
    return next(found for each, found in outcomes if each == which)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
