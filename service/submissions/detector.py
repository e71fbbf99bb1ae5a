"""Whether the detector is installed, for processes that may not load it.

Only this machine is checked. Workers may run elsewhere with the same settings: if one of them lacks
the detector, its fit fails with the same code.
"""

import importlib.util
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from api_schemas.problems import FieldProblem
from api_schemas.requests import FitOptions
from service.setting_types import DETECTOR_FILES
from service.submissions.refusal import refused

DETECTOR_MISSING: Final = "detector-not-installed"

RUNTIME: Final = "ai_edge_litert"
CARRIER: Final = "mediapipe"
CARRIER_FOLDERS: Final = ("modules/pose_detection", "modules/pose_landmark")
"""Where the package has each of the files."""

NOT_INSTALLED: Final = "The detector that proposes points is not installed in this service."
REMEDY: Final = (
    "Click the points, or have the detector installed: pip install 'maquette[detector]' && "
    "pip install --no-deps mediapipe==0.10.21."
)


def detector_is_installed(folder: Path | None) -> bool:
    """Whether runtime and weights are there, the weights in a folder or in their package.

    Neither is loaded.
    """
    if importlib.util.find_spec(RUNTIME) is None:
        return False
    return all(path.is_file() for path in _weights(folder))


def check_detector(options: FitOptions, folder: Path | None) -> None:
    """Refuse a request that needs the detector if there is none.

    Raises
    ------
    RefusedError
        ``detector-not-installed``, of the field that asks for it.
    """
    if not options.complete_points or detector_is_installed(folder):
        return
    raise refused(
        FieldProblem(
            field="complete_points" if options.points else "points",
            code=DETECTOR_MISSING,
            reason=NOT_INSTALLED,
            remedy=REMEDY,
        )
    )


def _weights(folder: Path | None) -> Iterator[Path]:
    if folder is not None:
        yield from (folder / name for name in DETECTOR_FILES)
        return
    # Finding a package does not import it.
    package = importlib.util.find_spec(CARRIER)
    root = Path() if package is None or package.origin is None else Path(package.origin).parent
    yield from (
        root / within / name for within, name in zip(CARRIER_FOLDERS, DETECTOR_FILES, strict=True)
    )
