"""Means and covariances of ANSUR II's own fields, to hold the body models' measurements against.

Not what training draws from (:mod:`fitter.training.surveys.survey`, logarithms), but the plain
figures a report compares with: centimetres and kilograms, as the survey defines its fields, arms
flexed. ``python -m fitter.training.surveys.survey_moments FOLDER`` makes
``data/survey_moments.json`` from the public release's two CSV files.
"""

import csv
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

FIELDS = (
    "stature",
    "weightkg",
    "chestcircumference",
    "waistcircumference",
    "buttockcircumference",
    "neckcircumference",
    "headcircumference",
    "thighcircumference",
    "calfcircumference",
    "anklecircumference",
    "bicepscircumferenceflexed",
    "forearmcircumferenceflexed",
    "wristcircumference",
    "biacromialbreadth",
    "waistbacklength",
    "acromionradialelength",
    "radialestylionlength",
    "handlength",
    "footlength",
    "acromialheight",
    "cervicaleheight",
    "suprasternaleheight",
    "crotchheight",
    "trochanterionheight",
    "lateralfemoralepicondyleheight",
    "lateralmalleolusheight",
    "neckcircumferencebase",
    "handcircumference",
    "lowerthighcircumference",
    "verticaltrunkcircumferenceusa",
    "shoulderlength",
    "interscyei",
    "interscyeii",
    "waistfrontlengthsitting",
    "span",
    "crotchlengthomphalion",
    "crotchlengthposterioromphalion",
    "axillaheight",
    "chestheight",
    "waistheightomphalion",
    "buttockheight",
    "kneeheightmidpatella",
    "headbreadth",
    "headlength",
    "chestbreadth",
    "chestdepth",
    "waistbreadth",
    "waistdepth",
    "hipbreadth",
    "buttockdepth",
)

FILE_NAMES = {
    "female": "ANSUR_II_FEMALE_Public.csv",
    "male": "ANSUR_II_MALE_Public.csv",
}

UNITS_PER_OURS = 10.0
"""The files have millimetres and tenths of a kilogram."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurveyMoments:
    """First and second moments of survey fields among one gender; centimetres and kilograms."""

    names: tuple[str, ...]
    count: int
    mean: Float[np.ndarray, " q"]
    covariance: Float[np.ndarray, "q q"]

    def of(
        self, combinations: Sequence[Mapping[str, float]]
    ) -> tuple[Float[np.ndarray, " c"], Float[np.ndarray, "c c"]]:
        """Mean and covariance of weighted sums of fields."""
        rows = np.array(
            [[weights.get(name, 0.0) for name in self.names] for weights in combinations]
        )
        unknown = {name for weights in combinations for name in weights} - set(self.names)
        if unknown:
            message = f"no moments of {', '.join(sorted(unknown))}"
            raise KeyError(message)
        return rows @ self.mean, rows @ self.covariance @ rows.T


def packaged_moments_path() -> Path:
    """The committed moments."""
    return Path(__file__).parent / "data" / "survey_moments.json"


def load_moments(path: Path, gender: str) -> SurveyMoments:
    """Read the moments of ``female`` or ``male``."""
    content = json.loads(path.read_text())[gender]
    return SurveyMoments(
        names=tuple(content["names"]),
        count=int(content["count"]),
        mean=np.array(content["mean"]),
        covariance=np.array(content["covariance"]),
    )


def surveyed_values(path: Path, names: Sequence[str]) -> Float[np.ndarray, "s q"]:
    """Fields of everybody in one gender's file of the public release (CSV, latin-1); cm and kg."""
    with path.open(encoding="latin-1", newline="") as stream:
        subjects = list(csv.DictReader(stream))
    values = np.array([[float(subject[name]) for name in names] for subject in subjects])
    return values / UNITS_PER_OURS


def moments_from_survey(path: Path, names: Sequence[str]) -> SurveyMoments:
    """Moments of one gender's file."""
    values = surveyed_values(path, names)
    return SurveyMoments(
        names=tuple(names),
        count=len(values),
        mean=values.mean(axis=0),
        covariance=np.cov(values.T),
    )


def save_moments(path: Path, genders: Mapping[str, SurveyMoments]) -> None:
    """Write the moments of both genders."""
    content = {
        "source": "ANSUR II, US Army Anthropometric Survey 2012, public release",
        "units": "centimetres, kilograms",
    } | {
        gender: {
            "names": list(moments.names),
            "count": moments.count,
            "mean": np.round(moments.mean, 4).tolist(),
            "covariance": np.round(moments.covariance, 5).tolist(),
        }
        for gender, moments in genders.items()
    }
    path.write_text(json.dumps(content) + "\n")


def main(folder: Path) -> None:
    """Rewrite the packaged moments from the files in a folder."""
    save_moments(
        packaged_moments_path(),
        {gender: moments_from_survey(folder / name, FIELDS) for gender, name in FILE_NAMES.items()},
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
