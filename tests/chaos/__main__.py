"""``python -m tests.chaos``: real fits and products while processes are killed at random.

On SQLite and on Postgres (a database of its own on 127.0.0.1:5432). Nothing is faked: the pictures
are small and fitted by silhouette and edges, so that a hundred jobs take minutes. Exits with 1 if a
job was lost, ended twice or otherwise than undisturbed, or anything was left behind.
"""

import argparse
import contextlib
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from tests.chaos.caller import Outcome, Product, Task, references
from tests.chaos.run import Plan, disturb
from tests.chaos.verdict import verdict
from tests.deployment import Deployment, Kind
from tests.postgres import fresh_database
from tests.submissions import small_submissions

DATABASES = ("sqlite", "postgres")
PICTURES = 6
PRODUCTS = (
    {"kind": "pose", "pose": "sitting"},
    {"kind": "texture", "size": 512},
    {"kind": "caricature", "factor": 1.5},
    {"kind": "animation", "motion": "walk", "duration_s": 0.2},
    {"kind": "print"},
    {"kind": "composition"},
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
    products = [Product(of=fits[0], request=each) for each in PRODUCTS]
    tasks = [task for pair in zip(fits, products, strict=True) for task in pair]
    kills = {kind: max(1, round(share * options.kills)) for kind, share in SHARES.items()}
    plan = Plan(jobs=options.jobs, kills=kills, seed=options.seed)
    status = 0
    for name in options.database or DATABASES:
        load = ", ".join(f"{value:.1f}" for value in os.getloadavg())
        print(f"\n{name}, seed {plan.seed} (load averages before: {load})", flush=True)
        folder = Path(tempfile.mkdtemp(prefix="maquette-chaos-"))
        expected = references(Deployment(folder=folder / "undisturbed"), tasks)
        failed = _killed(name, folder, tasks, plan, expected)
        status |= failed
        if not failed:
            shutil.rmtree(folder)
    return status


def _killed(
    name: str, folder: Path, tasks: Sequence[Task], plan: Plan, expected: Sequence[Outcome]
) -> int:
    with contextlib.ExitStack() as stack:
        url = stack.enter_context(fresh_database()) if name == "postgres" else None
        deployment = Deployment(folder=folder / "disturbed", database_url=url)
        stack.callback(deployment.end)
        deployment.start()
        judged = verdict(deployment, disturb(deployment, tasks, plan), expected)
    return _told(judged.lines(), judged.faults, folder)


def _told(lines: Iterator[str], faults: Mapping[str, object], folder: Path) -> int:
    for line in lines:
        print(line, flush=True)
    if faults:
        print(f"FAULTS: {faults}; data and log are kept in {folder}", flush=True)
    return int(bool(faults))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.chaos", description=__doc__)
    parser.add_argument(
        "--database", action="append", choices=DATABASES, help="on this alone (default: both)"
    )
    parser.add_argument("--jobs", type=int, default=110, help="default: %(default)s")
    parser.add_argument("--kills", type=int, default=36, help="default: %(default)s")
    parser.add_argument("--seed", type=int, default=2009, help="default: %(default)s")
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
