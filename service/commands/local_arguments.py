"""The arguments of the commands that work on pictures here and now: fit, scan and check.

Nothing is imported for them before they are parsed: every command loads this module.
"""

import argparse
from pathlib import Path


def add_fit_arguments(fit: argparse.ArgumentParser) -> None:
    """Add those of ``maquette fit``."""
    fit.add_argument("image", type=Path, metavar="IMAGE", help="JPEG, PNG, WebP or HEIC")
    fit.add_argument(
        "--points",
        type=Path,
        metavar="FILE",
        help='JSON: a whole request, or {"points": {...}} (default: all points are proposed)',
    )
    fit.add_argument(
        "--complete-points", action="store_true", help="propose the points that FILE has not"
    )
    fit.add_argument("--gender", choices=("female", "male"))
    fit.add_argument("--height-m", type=float, metavar="METRES")
    fit.add_argument("--weight-kg", type=float, metavar="KILOGRAMS")
    fit.add_argument("--focal-length-px", type=float, metavar="PIXELS")
    fit.add_argument("--focal-length-35mm", type=float, metavar="MM")
    fit.add_argument("--cues", choices=("SE", "SES"))
    fit.add_argument("--optimizer", choices=("gauss_newton", "simplex"))
    fit.add_argument(
        "--paper", action="store_true", help="as the paper does, without what was added to it"
    )
    fit.add_argument(
        "--energies",
        nargs="+",
        choices=("silhouette", "edges", "penetration", "shading"),
        help="as the paper, with these terms alone",
    )
    fit.add_argument(
        "--free-height", action="store_true", help="as the paper, and find the height too"
    )
    fit.add_argument(
        "--view",
        choices=("front", "side", "back", "other"),
        help="from where the picture shows the person, if it was taken to be measured",
    )
    fit.add_argument("--mask", type=Path, metavar="IMAGE", help="replaces the segmentation")
    _add_common(fit, output="maquette-fit")


def add_scan_arguments(scan: argparse.ArgumentParser) -> None:
    """Add those of ``maquette scan``."""
    scan.add_argument(
        "images",
        type=Path,
        nargs="+",
        metavar="IMAGE",
        help="2 to 6: from the front, from the side, and others",
    )
    scan.add_argument(
        "--views",
        nargs="+",
        default=(),
        metavar="VIEW",
        help="what the pictures show, in their order: front, side, back or other",
    )
    scan.add_argument(
        "--points",
        type=_points_file,
        nargs="+",
        default=(),
        metavar="FILE",
        help="a JSON file as for a fit, or auto, for every picture (default: auto); what "
        "the first says of the person holds",
    )
    scan.add_argument("--gender", choices=("female", "male"))
    scan.add_argument("--height-m", type=float, metavar="METRES")
    scan.add_argument("--weight-kg", type=float, metavar="KILOGRAMS")
    scan.add_argument("--focal-length-35mm", type=float, metavar="MM", help="of all pictures")
    scan.add_argument("--cues", choices=("SE", "SES"))
    scan.add_argument("--optimizer", choices=("gauss_newton", "simplex"))
    _add_common(scan, output="maquette-scan")


def add_check_arguments(check: argparse.ArgumentParser) -> None:
    """Add those of ``maquette check``."""
    check.add_argument("image", type=Path, metavar="IMAGE", help="JPEG, PNG, WebP or HEIC")
    check.add_argument(
        "--view",
        choices=("front", "side", "back", "other"),
        help="from where the person is to be seen",
    )
    check.add_argument(
        "--points", type=Path, metavar="FILE", help="JSON of a request: points of who is meant"
    )
    check.add_argument("--gender", choices=("female", "male"))
    check.add_argument("--height-m", type=float, metavar="METRES")
    check.add_argument("--focal-length-px", type=float, metavar="PIXELS")
    check.add_argument("--focal-length-35mm", type=float, metavar="MM")


def add_paper_arguments(paper: argparse.ArgumentParser) -> None:
    """Add those of ``maquette paper``."""
    for name, shown in (("--picture", "of Figs. 2, 3, 5, 7 and 9"), ("--painting", "of Fig. 10")):
        paper.add_argument(
            name,
            type=Path,
            nargs=2,
            metavar=("IMAGE", "FILE"),
            help=f"{shown}, with a JSON file of its request",
        )
    paper.add_argument("--motion", type=Path, metavar="BVH", help="motion capture, of Fig. 9")
    paper.add_argument(
        "--output",
        type=Path,
        default=Path("maquette-paper"),
        metavar="DIR",
        help="default: %(default)s",
    )


def _add_common(command: argparse.ArgumentParser, *, output: str) -> None:
    """Add what may be said of any work on pictures here and now."""
    command.add_argument(
        "--force", action="store_true", help="give measurements even if nothing shows a person"
    )
    command.add_argument(
        "--models",
        type=Path,
        metavar="DIR",
        help="folder of female.npz or male.npz (default: the packaged body models)",
    )
    command.add_argument(
        "--formats",
        type=_formats,
        default=(),
        metavar="FORMAT,...",
        help="write every mesh as obj, ply or stl too",
    )
    command.add_argument(
        "--output", type=Path, default=Path(output), metavar="DIR", help="default: %(default)s"
    )


def _points_file(text: str) -> Path | None:
    from api_schemas.points import AUTO

    return None if text == AUTO else Path(text)


def _formats(text: str) -> tuple[str, ...]:
    from service.representation.formats import MESH_FORMATS

    endings = tuple(dict.fromkeys(each.strip().lstrip(".").lower() for each in text.split(",")))
    for ending in endings:
        if ending not in MESH_FORMATS:
            message = f"'{ending}' is none of {', '.join(MESH_FORMATS)}; GLB is always written"
            raise argparse.ArgumentTypeError(message)
    return endings
