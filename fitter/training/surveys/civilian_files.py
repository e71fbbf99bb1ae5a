"""Condense NHANES 2017-2018 to the statistics that training draws civilians from.

``python -m fitter.training.surveys.civilian_files FILE`` reads the survey's combined table (tab
separated, one person a row, as the package ``nhanes`` 0.5.1 carries it) and rewrites
``data/civilian_statistics.json``.
"""

import csv
import itertools
import json
import sys
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.training.surveys.civilians import CivilianStatistics, packaged_civilians_path

COLUMNS = ("AgeInYearsAtScreening", "StandingHeightCm", "BodyMassIndexKgm2", "WaistCircumferenceCm")
GENDERS = {"female": "Female", "male": "Male"}

AGE_GROUPS = (18.0, 25.0, 35.0, 45.0, 55.0, 65.0, 75.0, 200.0)
"""Years; the survey writes 80 for everybody older."""

CENTIMETRES_PER_METRE = 100.0


def civilian_statistics(people: Float[np.ndarray, "p 4"]) -> CivilianStatistics:
    """Statistics by age group of people given by :data:`COLUMNS`."""
    age = people[:, 0]
    logarithms = np.log(people[:, 1:] / [CENTIMETRES_PER_METRE, 1.0, CENTIMETRES_PER_METRE])
    groups = [(age >= low) & (age < high) for low, high in itertools.pairwise(AGE_GROUPS)]
    means = np.array([logarithms[group].mean(axis=0) for group in groups])
    return CivilianStatistics(
        count=np.array([group.sum() for group in groups]),
        age=np.array([age[group].mean() for group in groups]),
        log_stature=means[:, 0],
        log_bmi=means[:, 1],
        log_waist=means[:, 2],
        log_covariance=np.array([np.cov(logarithms[group, :2].T) for group in groups]),
    )


def read_people(path: Path, gender: str) -> Float[np.ndarray, "p 4"]:
    """Adults of one gender with all four measurements."""
    with path.open(newline="") as stream:
        rows = [
            [row[column] for column in COLUMNS]
            for row in csv.DictReader(stream, delimiter="\t")
            if row["Gender"] == GENDERS[gender] and all(row[column] for column in COLUMNS)
        ]
    people = np.array(rows, dtype=np.float64)
    return people[(people[:, 0] >= AGE_GROUPS[0]) & np.isfinite(people).all(axis=1)]


def main(path: Path) -> None:
    """Rewrite the packaged statistics."""
    content: dict[str, object] = {
        "source": "NHANES 2017-2018, US Centers for Disease Control and Prevention, public domain",
        "definition": "by age group: people counted, mean age, means of natural logarithms of "
        "stature (m), body mass index (kg/m2) and waist above the iliac crest (m), covariance of "
        "the first two",
    }
    for gender in GENDERS:
        found = civilian_statistics(read_people(path, gender))
        content[gender] = {
            name: np.round(getattr(found, name), 6).tolist()
            for name in CivilianStatistics.__dataclass_fields__
        }
    packaged_civilians_path().write_text(json.dumps(content) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
