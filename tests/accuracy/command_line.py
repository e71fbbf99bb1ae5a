"""What ``python -m tests.accuracy`` can be asked."""

import argparse
from pathlib import Path

from fitter.vocabulary.choices import Clothing
from tests.accuracy.cases import CASES
from tests.accuracy.foreign import foreign_names
from tests.accuracy.scene import Half, Series
from tests.accuracy.spoilt import KINDS
from tests.accuracy.table import MEASUREMENTS


def parser(description: str | None) -> argparse.ArgumentParser:
    """Options that choose pictures, what fits are told, or something else to do."""
    found = argparse.ArgumentParser(prog="python -m tests.accuracy", description=description)
    _add_choice(found)
    _add_told(found)
    _add_modes(found)
    return found


def _add_choice(to: argparse.ArgumentParser) -> None:
    to.add_argument(
        "--half",
        choices=[half.value for half in Half],
        help="choose constants on tuning, report figures on reporting (default: both)",
    )
    to.add_argument(
        "--set",
        choices=[series.value for series in Series],
        help="default: all but the pairs from front and side",
    )
    to.add_argument(
        "--case",
        action="append",
        choices=[*CASES, *foreign_names()],
        metavar="NAME",
        help="these alone (default: all)",
    )
    to.add_argument("--jobs", type=int, default=1, help="fits made side by side")
    to.add_argument(
        "--page", type=Path, metavar="DIR", help="write an HTML page with pictures of every fit"
    )


def _add_told(to: argparse.ArgumentParser) -> None:
    to.add_argument(
        "--true-mask",
        action="store_true",
        help="give the person's true mask: what the errors would be without segmentation",
    )
    to.add_argument(
        "--clothing",
        choices=[each.value for each in Clothing],
        help="how clothes are said to lie (default: auto; of clothed and dressed people each)",
    )
    to.add_argument(
        "--known-focal",
        action="store_true",
        help="give the focal length in pixels, where it is in the file or missing too",
    )
    to.add_argument(
        "--given",
        action="append",
        choices=[key for _, key, _ in MEASUREMENTS],
        help="give this measurement, as a caller of the service may; may be repeated",
    )


def _add_modes(to: argparse.ArgumentParser) -> None:
    for name, what in (
        ("--paper", "fit by the paper's own method and by ours, on the same pictures"),
        (
            "--checks",
            "fit nothing: how often the checks of a capture find what is wrong, and what is not",
        ),
        (
            "--spoilt",
            "measure people behind things, cropped, told wrongly, in the dark: errors, intervals",
        ),
        (
            "--covers",
            "fit people in gloves, masks, beards, stockings, dark skin, cloth of the skin's colour",
        ),
        (
            "--scan",
            "measure people from the front, from the side and from both, foreign ones too",
        ),
    ):
        to.add_argument(name, action="store_true", help=what)
    to.add_argument(
        "--kind", action="append", choices=KINDS, metavar="KIND", help="with --spoilt: these alone"
    )
    to.add_argument(
        "--proposed",
        action="store_true",
        help="with --scan: by points that the detector proposes, in place of clicks",
    )
