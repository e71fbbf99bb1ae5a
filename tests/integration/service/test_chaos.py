"""Random kills of workers and fits: every accepted job ends once, with its result."""

import contextlib
import os
import random
import signal
import subprocess
import time
from pathlib import Path

from tests.integration.service.harness import (
    Machine,
    is_running,
    pids_noted,
    running_service,
    running_worker,
)

JOBS = 16
KILLS = 6
WORKERS = 2


def test_every_job_ends_once_whoever_is_killed(machine: Machine, tmp_path: Path):
    chance = random.Random(20090929)
    note = tmp_path / "pids"
    with contextlib.ExitStack() as stack:
        service = stack.enter_context(running_service(machine, api_only=True))
        script = {"seconds": 0.5, "note_pid": str(note)}
        paths = [service.submit(script | {"number": number}) for number in range(JOBS)]
        workers: list[subprocess.Popen[str]] = []
        for kill in range(KILLS + 1):
            while len(workers) < WORKERS:
                workers.append(stack.enter_context(running_worker(machine)))
            if kill == KILLS:
                break
            time.sleep(chance.uniform(0.5, 1.5))
            fits = [pid for pid in pids_noted(note) if is_running(pid)]
            # A fit killed three times would be given up: most kills go to workers.
            if fits and chance.random() < 0.3:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(chance.choice(fits), signal.SIGKILL)
            else:
                victim = workers.pop(chance.randrange(len(workers)))
                victim.kill()
                victim.wait()
        jobs = [service.ended(path, within_s=60.0) for path in paths]
        assert [job["state"] for job in jobs] == ["succeeded"] * JOBS
        assert sum(job["attempt"] for job in jobs) > JOBS, "no kill has hit a fit"
        for path, job in zip(paths, jobs, strict=True):
            assert [event["event"] for event in service.events(path)].count("end") == 1
            assert service.client.get(job["links"]["result"]).status_code == 200
