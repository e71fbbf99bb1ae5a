"""``python -m tests.benchmarks``: what a fit and the service take. Printed, never asserted."""

import argparse
import importlib
import os
import platform
import sys
from collections.abc import Sequence

from tests.benchmarks.checkouts import BASELINE

# Before numpy is loaded: one thread a fit, as in the service.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_variable] = "1"

FITS = {
    "goals": 3,
    "stages": 20,
    "simplex": 3,
    "idle": 3,
    "throughput": 10,
    "demo": 3,
    "upload": 5,
    "overhead": 20,
}
"""The parts, each a module of this package, and how many fits each makes unless told otherwise:
of ``goals`` rounds, of ``idle`` services, of ``demo`` runs."""


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    print(f"{platform.machine()}, {os.cpu_count()} processors, Python {platform.python_version()}")
    if options.against is not None:
        for line in importlib.import_module("tests.benchmarks.against").lines(options.against):
            print(line, flush=True)
        return 0
    for part in options.part or FITS:
        load = ", ".join(f"{value:.1f}" for value in os.getloadavg())
        print(f"\n{part} (load averages before: {load})")
        module = importlib.import_module(f"tests.benchmarks.{part}")
        for line in module.lines(options.fits or FITS[part]):
            print(line, flush=True)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks", description=__doc__)
    parser.add_argument(
        "--part", action="append", choices=list(FITS), help="these alone (default: all)"
    )
    counts = ", ".join(f"{count} {part}" for part, count in FITS.items())
    parser.add_argument(
        "--against",
        nargs="?",
        const=BASELINE,
        metavar="REVISION",
        help="instead, compare fits of one picture and of several, and uploads, with another "
        "revision, or the checkout in a folder, in turns (given no other: that of the goals)",
    )
    parser.add_argument("--fits", type=int, help=f"fits of each part (default: {counts})")
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
