"""Means and covariances of ANSUR II's own fields, to hold the body models' measurements against.

Not what training draws from (:mod:`fitter.training.surveys.survey`, logarithms), but the plain
figures a report compares with: centimetres and kilograms, as the survey defines its fields, arms
flexed. They are kept in ``data/survey_moments.json``.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float


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
