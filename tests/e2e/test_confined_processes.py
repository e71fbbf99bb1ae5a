"""Processes that decode pictures, of a real service: what they know and may do."""

import os
from collections.abc import Iterator
from pathlib import Path

import httpx

from service.process.confinement import NEEDED
from service.settings import PREFIX

REPOSITORY = Path(__file__).parents[2]
FORK_SERVER = b"multiprocessing.forkserver"


def forked() -> Iterator[Path]:
    """The fork servers of this checkout that run, and what they have forked."""
    for process in Path("/proc").glob("[0-9]*"):
        try:
            command = (process / "cmdline").read_bytes()
            if FORK_SERVER in command and os.fsencode(REPOSITORY) in command:
                (process / "environ").read_bytes()
                yield process
        except OSError:
            # It has just ended, or is another user's.
            continue


def test_they_know_no_secrets_and_gain_no_privileges(service: httpx.Client, finished_fit: str):
    service.get(f"/v1/fits/{finished_fit}").raise_for_status()
    processes = list(forked())
    assert "estimator" in {(each / "comm").read_text().strip() for each in processes}
    for process in processes:
        names = {each.partition("=")[0] for each in (process / "environ").read_text().split("\0")}
        assert {name for name in names if name.startswith(PREFIX)} <= NEEDED
        assert f"{PREFIX}PORT" not in names
        assert "NoNewPrivs:\t1" in (process / "status").read_text()
