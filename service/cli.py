"""``maquette serve | worker | prepare | keys | health | fit | demo | warm-up | openapi``.

Every command imports what it needs itself: ``maquette --help`` and the processes forked by a worker
load this module and nothing heavy with it.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from service.settings import Settings

UNUSABLE: Final = 2
"""Exit status where settings, arguments or what they name cannot be used."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run a command and exit with its status."""
    parsed = _parser().parse_args(arguments)
    command: Callable[[argparse.Namespace], int] = parsed.command
    sys.exit(command(parsed))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="maquette",
        description="A measured 3D body from a single picture. "
        "The service is configured by environment variables named MAQUETTE_...; see the README.",
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
    actions.add_parser("list", help="list all keys")
    revoke = actions.add_parser("revoke", help="make a key useless")
    revoke.add_argument("id", help="the part of the key between the underscores")
    keys.set_defaults(command=_keys)

    health = commands.add_parser("health", help="exit with 0 if the service here is ready")
    health.add_argument("--worker", action="store_true", help="ask for the worker, not the API")
    health.set_defaults(command=_health)

    fit = commands.add_parser("fit", help="fit one picture here and now, without a service")
    fit.add_argument("image", type=Path, metavar="IMAGE", help="JPEG, PNG or WebP")
    fit.add_argument(
        "--points",
        type=Path,
        required=True,
        metavar="FILE",
        help='JSON: a whole request, or {"points": {...}}',
    )
    fit.add_argument("--gender", choices=("female", "male"))
    fit.add_argument("--height-m", type=float, metavar="METRES")
    fit.add_argument("--weight-kg", type=float, metavar="KILOGRAMS")
    fit.add_argument("--focal-length-px", type=float, metavar="PIXELS")
    fit.add_argument("--focal-length-35mm", type=float, metavar="MM")
    fit.add_argument("--cues", choices=("SE", "SES"))
    fit.add_argument("--optimizer", choices=("gauss_newton", "simplex"))
    fit.add_argument("--mask", type=Path, metavar="IMAGE", help="replaces the segmentation")
    fit.add_argument(
        "--models",
        type=Path,
        metavar="DIR",
        help="folder of female.npz or male.npz (default: the packaged body models)",
    )
    fit.add_argument(
        "--output",
        type=Path,
        default=Path("maquette-fit"),
        metavar="DIR",
        help="default: %(default)s",
    )
    fit.set_defaults(command=_fit)

    demo = commands.add_parser("demo", help="start a service, fit the sample picture, show it all")
    demo.add_argument(
        "--output",
        type=Path,
        default=Path("demo-output"),
        metavar="DIR",
        help="default: %(default)s",
    )
    demo.set_defaults(command=_demo)

    warm_up = commands.add_parser("warm-up", help="compile what is compiled at first use")
    warm_up.set_defaults(command=_warm_up)

    openapi = commands.add_parser("openapi", help="print the OpenAPI document")
    openapi.add_argument("--output", type=Path, metavar="FILE", help="write it there instead")
    openapi.set_defaults(command=_openapi)
    return parser


def _serve(parsed: argparse.Namespace) -> int:
    from service.logs import configure_logging
    from service.serve import WORKER_COMMAND, listen, serve

    settings = _settings(
        "serve",
        **{
            name: value
            for name in ("host", "port", "data_dir", "models_dir")
            if (value := getattr(parsed, name)) is not None
        },
    )
    try:
        listener = listen(settings)
    except OSError as error:
        print(
            f"maquette serve: cannot listen on {settings.host}:{settings.port} "
            f"({error.strerror}). Stop what listens there, or choose another port with --port.",
            file=sys.stderr,
        )
        return UNUSABLE
    configure_logging(settings.log_level, settings.log_format)
    return _told(
        "serve",
        lambda: serve(
            settings,
            listener,
            worker_command=None if parsed.no_worker else WORKER_COMMAND,
            announce=lambda text: print(text, flush=True),
        ),
    )


def _worker(_: argparse.Namespace) -> int:
    from service.logs import configure_logging
    from service.worker.main import run_worker

    settings = _settings("worker")
    configure_logging(settings.log_level, settings.log_format)
    return _told("worker", lambda: run_worker(settings, follow_stdin=False))


def _prepare(_: argparse.Namespace) -> int:
    from service.logs import configure_logging
    from service.prepare_command import prepare

    settings = _settings("prepare")
    configure_logging(settings.log_level, settings.log_format)
    return _told("prepare", lambda: prepare(settings))


def _keys(parsed: argparse.Namespace) -> int:
    from service import key_commands
    from service.engine.keys import Role

    settings = _settings("keys")
    commands: dict[str, Callable[[], int]] = {
        "create": lambda: key_commands.create_key(
            settings, tenant=parsed.tenant, role=Role(parsed.role)
        ),
        "list": lambda: key_commands.list_keys(settings),
        "revoke": lambda: key_commands.revoke_key(settings, identity=parsed.id),
    }
    return _told("keys", commands[parsed.action])


def _health(parsed: argparse.Namespace) -> int:
    settings = _settings("health")
    if parsed.worker:
        from service.worker_health import worker_health

        return worker_health(settings)
    from service.api_health import api_health

    return api_health(settings)


def _settings(command: str, **given: object) -> "Settings":
    from pydantic import ValidationError

    from service.settings import Settings

    try:
        return Settings(**given)  # pyright: ignore[reportArgumentType]
    except ValidationError as error:
        for fault in error.errors():
            name = "".join(str(part) for part in fault["loc"])
            print(f"maquette {command}: {name}: {fault['msg']}.", file=sys.stderr)
        sys.exit(UNUSABLE)


def _told(command: str, run: Callable[[], int | None]) -> int:
    """Run a command; what only then turns out to be set wrong is said in a line."""
    from service.engine.database import DatabaseUnusableError
    from service.engine.port import EngineUnavailableError
    from service.settings import SettingError

    try:
        return run() or 0
    except (DatabaseUnusableError, SettingError) as error:
        print(f"maquette {command}: {error}", file=sys.stderr)
    except EngineUnavailableError:
        print(f"maquette {command}: the database is not available.", file=sys.stderr)
    return UNUSABLE


def _fit(parsed: argparse.Namespace) -> int:
    from service.local_fit import FitArguments, fit_locally

    return fit_locally(
        FitArguments(
            image=parsed.image,
            points=parsed.points,
            mask=parsed.mask,
            models=parsed.models,
            output=parsed.output,
            overrides={
                name: value
                for name in (
                    "gender",
                    "height_m",
                    "weight_kg",
                    "focal_length_px",
                    "focal_length_35mm",
                    "cues",
                    "optimizer",
                )
                if (value := getattr(parsed, name)) is not None
            },
        )
    )


def _demo(parsed: argparse.Namespace) -> int:
    from service.demo import run_demo

    return run_demo(parsed.output)


def _warm_up(_: argparse.Namespace) -> int:
    from service.local_fit import warm_up

    return warm_up()


def _openapi(parsed: argparse.Namespace) -> int:
    from service.api.app import openapi_text

    if parsed.output is None:
        print(openapi_text(), end="")
    else:
        parsed.output.write_text(openapi_text())
    return 0


if __name__ == "__main__":
    main()
