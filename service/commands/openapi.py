"""``maquette openapi``: the OpenAPI document, for the build."""

import argparse
from pathlib import Path

from service.api.app import openapi_text


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """File to write to."""
    parser.add_argument("--output", type=Path, metavar="FILE", help="write it there instead")


def run(parsed: argparse.Namespace) -> int:
    """Print or write it."""
    if parsed.output is None:
        print(openapi_text(), end="")
    else:
        parsed.output.write_text(openapi_text())
    return 0
