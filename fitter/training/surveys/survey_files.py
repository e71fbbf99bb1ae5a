"""Condense ANSUR II's files to the statistics that training draws subjects from.

``python -m fitter.training.surveys.survey_files FOLDER`` reads the public release's two CSV files
and rewrites ``data/survey_statistics.json``.
"""

import csv
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from fitter.training.surveys.survey import SurveyStatistics, packaged_statistics_path
from fitter.training.surveys.survey_measurements import MEASUREMENTS

FILE_NAMES = {
    "female": "ANSUR_II_FEMALE_Public.csv",
    "male": "ANSUR_II_MALE_Public.csv",
}

MILLIMETRES_PER_METRE = 1000.0
WEIGHT_UNITS_PER_KG = 10.0

SOURCE_NAMES = {"bicepscircumference": "bicepscircumferenceflexed"} | {
    "forearmcircumference": "forearmcircumferenceflexed"
}
"""Our names of fields that the survey names otherwise."""

RELAXED_SHARE = {"bicepscircumference": 0.93, "forearmcircumference": 0.96}
"""Girth of the relaxed over that of the flexed arm, which the survey measures: an assumption."""


def statistics_from_survey(path: Path, names: Sequence[str]) -> SurveyStatistics:
    """Statistics of one gender's file of the public release (CSV, latin-1)."""
    with path.open(encoding="latin-1", newline="") as stream:
        subjects = list(csv.DictReader(stream))
    columns = []
    for name in names:
        unit = WEIGHT_UNITS_PER_KG if name == "weightkg" else MILLIMETRES_PER_METRE
        field = SOURCE_NAMES.get(name, name)
        column = np.array([float(subject[field]) for subject in subjects]) / unit
        columns.append(np.log(column * RELAXED_SHARE.get(name, 1.0)))
    logarithms = np.stack(columns)
    ages = np.array([float(subject["Age"]) for subject in subjects])
    covariance = np.cov(np.vstack([logarithms, ages]))
    return SurveyStatistics(
        names=tuple(names),
        count=len(subjects),
        log_mean=logarithms.mean(axis=1),
        log_covariance=covariance[:-1, :-1],
        age_mean=float(ages.mean()),
        age_variance=float(covariance[-1, -1]),
        age_covariance=covariance[-1, :-1],
    )


def save_statistics(path: Path, genders: Mapping[str, SurveyStatistics]) -> None:
    """Write the statistics of both genders, six digits after the point."""
    content = {
        "source": "ANSUR II, US Army Anthropometric Survey 2012, public release",
        "definition": "mean and covariance of natural logarithms; metres, kilograms; flexed arm "
        "girths reduced to relaxed ones; age in years and its covariance with the logarithms",
        "relaxed_share": RELAXED_SHARE,
    } | {
        gender: {
            "names": list(statistics.names),
            "count": statistics.count,
            "log_mean": np.round(statistics.log_mean, 6).tolist(),
            "log_covariance": np.round(statistics.log_covariance, 8).tolist(),
            "age_mean": round(statistics.age_mean, 4),
            "age_variance": round(statistics.age_variance, 4),
            "age_covariance": np.round(statistics.age_covariance, 6).tolist(),
        }
        for gender, statistics in genders.items()
    }
    path.write_text(json.dumps(content) + "\n")


def main(folder: Path) -> None:
    """Rewrite the packaged statistics from the files in a folder."""
    save_statistics(
        packaged_statistics_path(),
        {
            gender: statistics_from_survey(folder / name, MEASUREMENTS)
            for gender, name in FILE_NAMES.items()
        },
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
