"""``python -m tests.fuzz``: damaged pictures, motions, bodies, headers and addresses, with figures.

Against `maquette serve` with its real worker and estimators. Exits with 1 if anything was answered
by 5xx (503 with Retry-After apart), by no problem document or not at all, if a fit met a fault or
killed its process, or if anything was left behind. ``--show N`` prints one input.
"""

import argparse
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tests.deployment import Deployment
from tests.fuzz.requests import KINDS
from tests.fuzz.run import fuzz, made


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    kinds = options.kind or tuple(KINDS)
    if options.show is not None:
        kind, request = made(options.show, options.seed, kinds)
        print(kind)
        sys.stdout.buffer.write(request.content)
        return 0
    load = ", ".join(f"{value:.1f}" for value in os.getloadavg())
    print(f"seed {options.seed} (load averages before: {load})", flush=True)
    with tempfile.TemporaryDirectory(prefix="maquette-fuzz-") as folder:
        deployment = Deployment(
            folder=Path(folder),
            workers=0,
            settings={
                "max_crashes": 3,
                "worker_processes": 2,
                # Room for everything: what a quota turns away is not looked at.
                "max_queued": options.inputs,
                "max_queued_per_tenant": options.inputs,
            },
        )
        try:
            harvest = fuzz(
                deployment,
                inputs=options.inputs,
                seed=options.seed,
                kinds=options.kind or tuple(KINDS),
            )
        finally:
            deployment.end()
            if options.log is not None:
                options.log.write_bytes(deployment.log.read_bytes())
        for line in harvest.lines():
            print(line, flush=True)
    return 1 if harvest.faults or harvest.fits_left or harvest.restarts else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--inputs", type=int, default=20_000, help="default: %(default)s")
    parser.add_argument("--seed", type=int, default=2009, help="default: %(default)s")
    parser.add_argument(
        "--kind", action="append", choices=KINDS, help="inputs of this kind alone (default: all)"
    )
    parser.add_argument("--show", type=int, metavar="N", help="print input N, and send nothing")
    parser.add_argument("--log", type=Path, metavar="FILE", help="keep the service's log there")
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
