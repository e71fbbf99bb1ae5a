"""``python -m tests.illustrations.subject``: the subject of the paper's Fig. 8, of the suite.

Somebody of the reporting half who is neither young nor old, thin nor heavy, chosen before any fit,
in the suite's three poses.
"""

import json
import sys
from pathlib import Path

import numpy as np

from service.demo_data.sample import FOLDER
from tests.accuracy.cases import CASES
from tests.accuracy.files import PICTURES_FOLDER, read_case
from tests.accuracy.people import load_person
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.scene import Kind
from tests.accuracy.staging import stage
from tests.accuracy.truth import true_body

PERSON = "man_122_middle_aged_middling"
STEP_M = 2e-4
"""A file's unit: rounding moves a vertex by less than 0.2 mm."""


def write_subject(folder: Path = FOLDER / "subject") -> None:
    """Pictures with their requests, and the true body at rest and in each pose."""
    folder.mkdir(parents=True, exist_ok=True)
    person, requests, posed = load_person(PEOPLE[PERSON]), {}, {}
    for kind in Kind:
        case = CASES[f"{PERSON}_{kind.value}"]
        picture = (PICTURES_FOLDER / f"{case.name}.jpg").read_bytes()
        (folder / f"{kind.value}.jpg").write_bytes(picture)
        request = dict(read_case(case).request)
        view = {
            name: request.pop(name) for name in ("points", "focal_length_px") if name in request
        }
        requests[kind.value] = request | {"views": [view]}
        staged = stage(person, case)
        posed[kind.value] = _steps(staged.in_camera(staged.body))
    truth = true_body(person)
    document = {"requests": requests, "measurements": dict(truth.measurements)}
    (folder / "subject.json").write_text(json.dumps(document, indent=1) + "\n")
    np.savez_compressed(
        folder / "bodies.npz", step_m=STEP_M, canonical=_steps(truth.canonical), **posed
    )


def _steps(vertices: np.ndarray) -> np.ndarray:
    return np.rint(vertices / STEP_M).astype(np.int16)


if __name__ == "__main__":
    write_subject()
    sys.exit(0)
