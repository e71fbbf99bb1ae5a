"""Whether the detector is installed, for processes that may not load it.

Only this machine is checked. Workers may run elsewhere with the same settings: if one of them lacks
the detector, its fit fails with the same code.
"""

from pathlib import Path
from typing import Final

from api_schemas.fit import FitRequest
from api_schemas.points import AUTO
from api_schemas.problems import FieldProblem, Problem, problem
from fitter.detection.weights import INSTALLATION, detector_fault
from service.submissions.refusal import of_view, refused

DETECTOR_MISSING: Final = "detector-not-installed"

NOT_INSTALLED: Final = "The detector that proposes points is not installed in this service."
REMEDY: Final = f"Click the points, or have the detector installed: {INSTALLATION}."


def detector_is_installed(folder: Path | None) -> bool:
    """Whether runtime and weights are there, the weights in a folder or in their package.

    Neither is loaded.
    """
    return detector_fault(folder) is None


def no_detector() -> Problem:
    """Say that there is no detector here, and how to change that."""
    return problem("not-found", code=DETECTOR_MISSING, detail=NOT_INSTALLED, remedy=REMEDY)


def check_detector(asked: FitRequest, folder: Path | None) -> None:
    """Refuse a request that needs the detector if there is none.

    Raises
    ------
    RefusedError
        ``detector-not-installed``, of the field that asks for it.
    """
    for number, view in enumerate(asked.views):
        if view.are_points_completed and not detector_is_installed(folder):
            with of_view(number):
                raise refused(
                    FieldProblem(
                        field="points" if view.points == AUTO else "complete_points",
                        code=DETECTOR_MISSING,
                        reason=NOT_INSTALLED,
                        remedy=REMEDY,
                    )
                )
