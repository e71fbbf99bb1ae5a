"""``maquette serve``, ``fit`` and the other commands.

Of the modules in :mod:`service.commands` only that of the command which is run is imported:
``maquette --help`` and the processes forked by ``maquette worker`` load nothing heavy.
"""

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Final

from service.version import VERSION

COMMANDS: Final = {
    "serve": "serve the API, with a worker beside it",
    "worker": "run fits for the API of the same database",
    "keys": "make, list and revoke API keys",
    "health": "exit with 0 if the service here is ready",
    "fit": "fit pictures here and now, without a service",
    "validate": "say how far fits are off on people who were measured with a tape",
    "paper": "draw the paper's figures and its table from fits made here and now",
    "demo": "start a service, fit the sample picture, show it all",
}
"""Each is a module of its name with ``add_arguments`` and ``run``, which gives the exit status."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run a command and exit with its status."""
    parsed = parse(sys.argv[1:] if arguments is None else arguments)
    sys.exit(parsed.run(parsed))


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Read the command line; ``run`` of what comes back is the command."""
    parser = argparse.ArgumentParser(
        prog="maquette",
        description="A measured 3D body from a single picture. "
        "The service is configured by environment variables named MAQUETTE_...; the documentation "
        "lists them (service/docs/operate/settings.md).",
    )
    parser.add_argument(
        "--version", action="version", version=f"maquette {VERSION}", help="print the version"
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name, shown in COMMANDS.items():
        command = commands.add_parser(name, help=shown)
        if name in arguments[:1]:
            module = import_module(f"service.commands.{name}")
            module.add_arguments(command)
            command.set_defaults(run=module.run)
    return parser.parse_args(arguments)


if __name__ == "__main__":
    main()
