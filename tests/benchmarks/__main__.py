"""``python -m tests.benchmarks``: what a fit and the service take. Printed, never asserted."""

import argparse
import importlib
import os
import platform
import sys
from collections.abc import Sequence

# Before numpy is loaded: one thread a fit, as in the service.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_variable] = "1"

FITS = {"demo": 3, "idle": 3, "overhead": 20, "several": 6, "throughput": 10}
"""The parts, each a module of this package, and how many fits each makes unless told otherwise;
of ``idle`` services, of ``demo`` runs."""


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    print(f"{platform.machine()}, {os.cpu_count()} processors, Python {platform.python_version()}")
    if options.against is not None:
        for line in importlib.import_module("tests.benchmarks.against").lines(options.against):
            print(line, flush=True)
        return 0
    if not options.part:
        print("\n".join(importlib.import_module("tests.benchmarks.goals").lines()))
        return 0
    for part in options.part:
        load = ", ".join(f"{value:.1f}" for value in os.getloadavg())
        print(f"\n{part} (load averages before: {load})")
        module = importlib.import_module(f"tests.benchmarks.{part}")
        for line in module.lines(options.fits or FITS[part]):
            print(line, flush=True)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks", description=__doc__)
    parser.add_argument(
        "--part",
        action="append",
        choices=list(FITS),
        help="this one in detail (default: all goals)",
    )
    counts = ", ".join(f"{count} {part}" for part, count in FITS.items())
    parser.add_argument(
        "--against",
        metavar="REVISION",
        help="instead, compare fits in turns with those of another revision, or of the checkout "
        "in a folder",
    )
    parser.add_argument("--fits", type=int, help=f"fits of each part (default: {counts})")
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
