"""``maquette serve``, ``fit`` and the other commands.

Every command imports what it needs itself: ``maquette --help`` and the processes forked by
``maquette worker`` load this module and nothing heavy with it.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from service.version import VERSION

UNUSABLE: Final = 2
"""Exit status where arguments, or what they name, cannot be used; that of settings is another."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run a command and exit with its status."""
    parsed = _parser().parse_args(arguments)
    command: Callable[[argparse.Namespace], int] = parsed.command
    sys.exit(command(parsed))


def _parser() -> argparse.ArgumentParser:
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

    serve = commands.add_parser("serve", help="serve the API, with a worker beside it")
    serve.add_argument("--host", help="address to listen on (default: the setting, 127.0.0.1)")
    serve.add_argument("--port", type=int, help="port, 0 for a free one (default: 8000)")
    serve.add_argument("--data-dir", type=Path, help="folder of database, pictures and results")
    serve.add_argument("--models-dir", type=Path, help="folder of female.npz and male.npz")
    serve.add_argument("--no-worker", action="store_true", help="the workers run elsewhere")
    serve.set_defaults(command=_serve)

    worker = commands.add_parser("worker", help="run fits for the API of the same database")
    worker.set_defaults(command=_worker)

    prepare = commands.add_parser(
        "prepare", help="make tables and bucket, where they are not there yet"
    )
    prepare.add_argument(
        "--adopt-storage",
        action="store_true",
        help="let this folder or bucket take the place of the one that the database had",
    )
    prepare.set_defaults(command=_prepare)

    keys = commands.add_parser("keys", help="make, list and revoke API keys")
    actions = keys.add_subparsers(required=True, dest="action", metavar="ACTION")
    create = actions.add_parser("create", help="make a key and print it, once")
    create.add_argument("tenant", help="whose jobs it opens; made by being named")
    create.add_argument(
        "--role",
        choices=("fits", "metrics"),
        default="fits",
        help="metrics: opens /metrics and nothing else (default: %(default)s)",
    )
    listing = actions.add_parser("list", help="list all keys")
    revoke = actions.add_parser("revoke", help="make a key useless")
    revoke.add_argument("id", help="the part of the key between the underscores")
    for action in (create, listing, revoke):
        action.add_argument("--data-dir", type=Path, help="that of the service")
    keys.set_defaults(command=_keys)

    health = commands.add_parser("health", help="exit with 0 if the service here is ready")
    health.add_argument("--worker", action="store_true", help="ask for the worker, not the API")
    health.set_defaults(command=_health)

    fit = commands.add_parser("fit", help="fit pictures here and now, without a service")
    fit.add_argument(
        "request", type=Path, metavar="REQUEST", help="JSON, as POST /v1/fits takes it"
    )
    fit.add_argument(
        "pictures",
        type=Path,
        nargs="+",
        metavar="PICTURE",
        help="one to six, in the order of the request's views: JPEG, PNG, WebP or HEIC",
    )
    fit.add_argument(
        "--mask",
        type=Path,
        action="append",
        default=[],
        metavar="PICTURE",
        help="replaces a picture's segmentation: none, or one for each picture",
    )
    fit.add_argument(
        "--format",
        choices=("obj", "ply", "stl"),
        action="append",
        default=[],
        help="write every mesh in this format too",
    )
    fit.add_argument(
        "--output",
        type=Path,
        default=Path("maquette-fit"),
        metavar="DIR",
        help="default: %(default)s",
    )
    fit.set_defaults(command=_fit)

    validate = commands.add_parser(
        "validate", help="say how far fits are off on people who were measured with a tape"
    )
    validate.add_argument(
        "people",
        type=Path,
        metavar="TABLE",
        help="CSV: a row for each fit (service/docs/validate.md)",
    )
    validate.add_argument(
        "--output",
        type=Path,
        default=Path("maquette-validation"),
        metavar="DIR",
        help="default: %(default)s",
    )
    validate.set_defaults(command=_validate)

    paper = commands.add_parser(
        "paper", help="draw the paper's figures and its table from fits made here and now"
    )
    paper.add_argument(
        "--painting",
        type=Path,
        nargs=2,
        metavar=("PICTURE", "REQUEST"),
        help="of Fig. 10, with the JSON of its request",
    )
    paper.add_argument(
        "--output",
        type=Path,
        default=Path("maquette-paper"),
        metavar="DIR",
        help="default: %(default)s",
    )
    paper.set_defaults(command=_draw_paper)

    demo = commands.add_parser("demo", help="start a service, fit the sample picture, show it all")
    demo.add_argument(
        "--output",
        type=Path,
        default=Path("demo-output"),
        metavar="DIR",
        help="default: %(default)s",
    )
    demo.set_defaults(command=_demo)

    # For the build: not listed.
    openapi = commands.add_parser("openapi", description="Print the OpenAPI document.")
    openapi.add_argument("--output", type=Path, metavar="FILE", help="write it there instead")
    openapi.set_defaults(command=_openapi)
    return parser


def _serve(parsed: argparse.Namespace) -> int:
    from service.commands.serve import WORKER_COMMAND, listen, serve
    from service.startup import begin, run_told

    settings = begin(
        "serve",
        {
            name: value
            for name in ("host", "port", "data_dir", "models_dir")
            if (value := getattr(parsed, name)) is not None
        },
    )

    def run() -> int:
        try:
            listener = listen(settings)
        except OSError as error:
            print(
                f"maquette serve: cannot listen on {settings.host}:{settings.port} "
                f"({error.strerror}). Stop what listens there, or choose another port with --port.",
                file=sys.stderr,
            )
            return UNUSABLE
        return serve(
            settings,
            listener,
            worker_command=None if parsed.no_worker else WORKER_COMMAND,
            announce=lambda text: print(text, flush=True),
        )

    return run_told("serve", run)


def _worker(_: argparse.Namespace) -> int:
    from service.compute.main import run_worker
    from service.startup import begin, run_told

    settings = begin("worker")
    return run_told("worker", lambda: run_worker(settings))


def _prepare(parsed: argparse.Namespace) -> int:
    from service.commands.prepare import prepare
    from service.startup import begin, run_told

    settings = begin("prepare")
    return run_told("prepare", lambda: prepare(settings, adopt_storage=parsed.adopt_storage))


def _keys(parsed: argparse.Namespace) -> int:
    from service.commands import keys
    from service.jobs.keys import Role
    from service.startup import read_settings, run_told, warn_of_unknown_names

    settings = read_settings("keys", _given(parsed, "data_dir"))
    warn_of_unknown_names()
    commands: dict[str, Callable[[], int]] = {
        "create": lambda: keys.create_key(settings, tenant=parsed.tenant, role=Role(parsed.role)),
        "list": lambda: keys.list_keys(settings),
        "revoke": lambda: keys.revoke_key(settings, identity=parsed.id),
    }
    return run_told("keys", commands[parsed.action])


def _health(parsed: argparse.Namespace) -> int:
    from service.startup import read_settings, warn_of_unknown_names

    settings = read_settings("health")
    warn_of_unknown_names()
    if parsed.worker:
        from service.commands.worker_health import worker_health

        return worker_health(settings)
    from service.commands.api_health import api_health

    return api_health(settings)


def _fit(parsed: argparse.Namespace) -> int:
    from service.commands.fit import FitArguments, fit_locally
    from service.startup import read_settings

    if parsed.mask and len(parsed.mask) != len(parsed.pictures):
        print("maquette fit: give no --mask, or one for each picture.", file=sys.stderr)
        return UNUSABLE
    read_settings("fit")
    return fit_locally(
        FitArguments(
            request=parsed.request,
            pictures=parsed.pictures,
            masks=parsed.mask,
            output=parsed.output,
            formats=parsed.format,
        )
    )


def _validate(parsed: argparse.Namespace) -> int:
    from service.commands.validate import validate
    from service.startup import read_settings

    return validate(parsed.people, parsed.output, models=read_settings("validate").models_dir)


def _given(parsed: argparse.Namespace, *names: str) -> dict[str, object]:
    """Those of these arguments that were given."""
    return {name: value for name in names if (value := getattr(parsed, name)) is not None}


def _draw_paper(parsed: argparse.Namespace) -> int:
    from service.commands.paper import draw_paper
    from service.startup import read_settings

    return draw_paper(parsed.output, parsed.painting, read_settings("paper"))


def _demo(parsed: argparse.Namespace) -> int:
    from service.commands.demo import run_demo
    from service.startup import read_settings

    read_settings("demo")
    return run_demo(parsed.output)


def _openapi(parsed: argparse.Namespace) -> int:
    from service.api.app import openapi_text

    if parsed.output is None:
        print(openapi_text(), end="")
    else:
        parsed.output.write_text(openapi_text())
    return 0


if __name__ == "__main__":
    main()
