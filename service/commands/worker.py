"""``maquette worker``: more hands for the API of the same database and storage."""

import argparse

from service.compute.worker import run_worker
from service.startup import run_service


def add_arguments(_: argparse.ArgumentParser) -> None:
    """None: settings say it all."""


def run(_: argparse.Namespace) -> int:
    """Work until told to stop."""
    return run_service("worker", run_worker)
