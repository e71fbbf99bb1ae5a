"""``python -m tests.chaos``: real fits and derivations, random kill -9, and what was lost.

On SQLite, on Postgres (a database of its own on 127.0.0.1:5432), or on both. Nothing is faked: the
pictures are small and fitted by silhouette and edges, so that a hundred jobs take minutes. Exits
with 1 if a job was lost, ended twice or otherwise than undisturbed, or anything was left behind.
"""

import argparse
import contextlib
import os
import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tests.chaos.caller import Derived
from tests.chaos.reference import references
from tests.chaos.run import Plan, disturb
from tests.chaos.verdict import verdict
from tests.deployment import Deployment, Kind
from tests.postgres import fresh_database
from tests.submissions import small_submissions

DATABASES = ("sqlite", "postgres")
PICTURES = 6
DERIVED = (
    Derived(request={"kind": "pose", "pose": "sitting"}),
    Derived(request={"kind": "texture", "size": 512}),
    Derived(request={"kind": "caricature", "factor": 1.5}),
    Derived(request={"kind": "animation", "duration_s": 0.2}),
    Derived(request={"kind": "figure"}),
    Derived(request={"kind": "report"}),
)
SHARES = {
    Kind.API: 0.25,
    Kind.WORKER: 0.3,
    Kind.FIT: 0.3,
    Kind.FORK_SERVER: 0.1,
    Kind.ESTIMATOR: 0.05,
}


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    fits = small_submissions(PICTURES)
    tasks = [task for pair in zip(fits, DERIVED, strict=True) for task in pair]
    kills = {kind: max(1, round(share * options.kills)) for kind, share in SHARES.items()}
    plan = Plan(jobs=options.jobs, kills=kills, seed=options.seed)
    status = 0
    for name in options.database or DATABASES:
        load = ", ".join(f"{value:.1f}" for value in os.getloadavg())
        print(f"\n{name}, seed {plan.seed} (load averages before: {load})", flush=True)
        folder = Path(tempfile.mkdtemp(prefix="maquette-chaos-"))
        expected = references(Deployment(folder=folder / "undisturbed"), tasks)
        with contextlib.ExitStack() as stack:
            url = stack.enter_context(fresh_database()) if name == "postgres" else None
            deployment = Deployment(folder=folder / "disturbed", database_url=url)
            stack.callback(deployment.end)
            deployment.start()
            judged = verdict(deployment, disturb(deployment, tasks, plan), expected)
        for line in judged.lines():
            print(line, flush=True)
        if judged.faults:
            print(f"FAULTS: {judged.faults}; data and log are kept in {folder}", flush=True)
            status = 1
        else:
            shutil.rmtree(folder)
    return status


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.chaos", description=__doc__)
    parser.add_argument(
        "--database", action="append", choices=DATABASES, help="this alone (default: both)"
    )
    parser.add_argument("--jobs", type=int, default=110, help="default: %(default)s")
    parser.add_argument("--kills", type=int, default=36, help="default: %(default)s")
    parser.add_argument("--seed", type=int, default=2009, help="default: %(default)s")
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
