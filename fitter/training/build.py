"""From MakeHuman's data and a survey's statistics to the model file of one gender."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel, SparseRows
from fitter.body.storage import load_body_model, save_body_model
from fitter.training.articulation.bone_centres import with_skin_centres
from fitter.training.articulation.inner_points import with_inner_points
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.articulation.rig import load_rig
from fitter.training.articulation.rigged_bodies import RiggedMesh, rigged_bodies, rigged_mesh
from fitter.training.articulation.shoulder_girdle import with_shoulder_girdle
from fitter.training.articulation.volume_learning import with_volume_learned
from fitter.training.assemble import assemble_body_model, model_arrays, with_height_axis
from fitter.training.makehuman.body_space import BodySpace, load_body_space
from fitter.training.makehuman.landmarks import body_landmarks
from fitter.training.makehuman.meshes import load_base_mesh
from fitter.training.people.population import (
    Population,
    load_population,
    packaged_population_path,
    prepare,
    save_population,
    solve_population,
)
from fitter.training.plan import Plan
from fitter.training.report.header_figures import header_figures
from fitter.training.report.held_out_errors import HeldOutErrors, held_out_errors
from fitter.training.report.provenance import provenance

GENDERS = ("female", "male")

INNER_POINTS_STREAM, VOLUMES_STREAM = 1, 2
"""Of the seed: poses that landmarks are fitted in, and poses whose volume is asked for, are not
those of the pose term."""

PACKAGED_SEED = 1
"""That the committed populations were drawn from."""

KEPT_MEASUREMENTS = (
    "chestcircumference",
    "waistcircumference",
    "buttockcircumference",
    "weightkg",
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Materials:
    """What both genders share, and each gender's rigged mesh and space of bodies."""

    meshes: Mapping[str, RiggedMesh]
    spaces: Mapping[str, BodySpace]
    landmarks: SparseRows


def read_materials(folder: Path) -> Materials:
    """Read mesh, rig and targets from MakeHuman's data folder."""
    base = load_base_mesh(folder)
    spaces = {gender: load_body_space(folder, base, gender) for gender in GENDERS}
    cubes = load_rig(folder, base.groups, len(base.source_vertices))
    return Materials(
        meshes={
            gender: rigged_mesh(
                base, with_shoulder_girdle(with_skin_centres(cubes, base, space), base)
            )
            for gender, space in spaces.items()
        },
        spaces=spaces,
        landmarks=body_landmarks(folder, base, tuple(spaces.values())),
    )


def solved_population(
    materials: Materials,
    gender: str,
    *,
    count: int,
    seed: int,
    cache: Path | None,
    processes: int = 1,
    anew: bool = False,
) -> Population:
    """The first ``count`` subjects of a seed: a second each to solve where no file holds as many.

    The committed population is asked first, if the seed is its own, and then the cache, which also
    keeps what is solved. With ``anew`` neither is read.
    """
    path = None if cache is None else cache / f"population_{gender}_{seed}.npz"
    packaged = packaged_population_path(gender) if seed == PACKAGED_SEED else None
    for kept in () if anew else (packaged, path):
        if kept is not None and kept.exists():
            found = load_population(kept, materials.spaces[gender], count=count)
            if len(found.source_vertices) == count:
                return found
    workshop = prepare(materials.spaces[gender], materials.landmarks)
    population = solve_population(workshop, count, seed, processes=processes)
    if path is not None:
        save_population(path, population)
    return population


def train_model(
    materials: Materials, gender: str, population: Population, plan: Plan
) -> tuple[BodyModel, RegisteredBodies, HeldOutErrors]:
    """Train on the subjects that are not held out and test on those; the header says how.

    Returns the model, the held-out bodies and the model's errors on them.
    """
    held_out = subjects(population, slice(0, plan.held_out))
    training = subjects(population, slice(plan.held_out, plan.held_out + plan.subjects))
    mesh = materials.meshes[gender]
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
            np.random.default_rng([plan.seed, GENDERS.index(gender), INNER_POINTS_STREAM]),
        ),
        header=provenance(gender, training, plan),
        example_count=plan.examples,
        rng=np.random.default_rng([plan.seed, GENDERS.index(gender)]),
    )
    tested = rigged_bodies(mesh, held_out.source_vertices)
    volumes = np.random.default_rng([plan.seed, GENDERS.index(gender), VOLUMES_STREAM])
    corrected = with_volume_learned(trained.model, volumes)
    # The correction reaches the standing pose, in which height is measured.
    trained = with_height_axis(corrected, trained.coefficients)
    errors = held_out_errors(trained.model, tested)
    header = dict(trained.model.header) | header_figures(trained, taught, tested, errors)
    return replace(trained.model, header=header), tested, errors


def write_model(path: Path, model: BodyModel) -> BodyModel:
    """Write a model file at once or not at all, and read it back."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(".unfinished")
    save_body_model(unfinished, header=model.header, arrays=model_arrays(model))
    unfinished.replace(path)
    return load_body_model(path)


def held_out_bodies(
    materials: Materials, model: BodyModel, *, cache: Path | None, processes: int = 1
) -> RegisteredBodies:
    """The subjects that a model file says were held out: see :func:`solved_population`."""
    population = solved_population(
        materials,
        model.gender,
        count=int(str(model.header["held_out_subjects"])),
        seed=int(str(model.header["seed"])),
        cache=cache,
        processes=processes,
    )
    return rigged_bodies(materials.meshes[model.gender], population.source_vertices)


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
