"""A population of registered bodies at rest: subjects drawn from a survey, solved for one by one.

Every subject has a random stream of its own, made from the seed and its number, so a longer
population begins with the shorter one of the same seed.
"""

import multiprocessing
from dataclasses import dataclass, fields
from functools import partial
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.arrays import Triangles
from fitter.body.model import SparseRows
from fitter.training.makehuman.body_space import BodySpace, Traits, source_vertices
from fitter.training.makehuman.phenotypes import FACE_CHANGES, age_of_appearance
from fitter.training.people.subject_fit import Placed, Wanted, fit_subject, measured, place
from fitter.training.surveys.survey import (
    CivilianStatistics,
    SurveyStatistics,
    draw_civilian,
    draw_measurements,
    load_civilians,
    load_statistics,
    on_the_model,
    packaged_civilians_path,
    packaged_statistics_path,
)
from fitter.training.surveys.survey_measurements import (
    MEASUREMENTS,
    Row,
    named_rows,
    place_measurements,
)

PACKAGED_PEOPLE = Path(__file__).parent / "data"
"""The committed populations of both genders: the packaged models learned from those of seed 1."""

PLACEMENTS = 3
"""Placements of the cuts on the subject, each anew; a third brings the mean residual of the worst
measurement 3 mm nearer than two. What was reached is measured on one more placement."""

TIGHT = 0.1
"""Tolerance of a measurement in the survey's standard deviations."""

TIGHTER = dict.fromkeys(
    ("stature", "weightkg", "chestcircumference", "waistcircumference", "buttockcircumference"),
    0.05,
)
"""The same of what people know of themselves and clothes are cut by."""

LOOSE = {
    **dict.fromkeys(("hipbreadth", "buttockdepth", "waistbreadth", "waistdepth"), 0.3),
    **dict.fromkeys(("chestdepth", "headbreadth", "headlength"), 0.3),
    **dict.fromkeys(("acromialheight", "cervicaleheight", "suprasternaleheight"), 0.3),
}
"""The same where the model's definition is not quite the survey's."""

MACRO_SPREAD = 0.3
MUSCLE_SPREAD = 0.25
LOCAL_SPREAD = 0.4
"""Standard deviations of the prior on parameters, in their own units."""

CENTRE_SHARE = 0.5
"""The prior's centre is drawn with this share of its spread."""

FACE_SPREAD = 0.3

ARM_MOTION = 0.02
"""Share of the hand's motion above which skin moves with the arm's length."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Population:
    """Bodies of one gender at rest.

    Attributes
    ----------
    ages
        (s,) years.
    ancestries, faces
        (s, 3) and (s, c) the other traits of each subject.
    source_vertices
        (s, v, 3) float32, all source vertices of each subject, body frame, metres.
    parameters
        (s, p) solved, by ``parameter_names``.
    wanted, reached
        (s, q) measurements drawn and those of the body, metres and kilograms, by
        ``measurement_names``.
    """

    ages: Float[np.ndarray, " s"]
    ancestries: Float[np.ndarray, "s 3"]
    faces: Float[np.ndarray, "s c"]
    source_vertices: Float[np.ndarray, "s v 3"]
    parameters: Float[np.ndarray, "s p"]
    parameter_names: tuple[str, ...]
    wanted: Float[np.ndarray, "s q"]
    reached: Float[np.ndarray, "s q"]
    measurement_names: tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Workshop:
    """Everything that the subjects of a gender share.

    ``trunk`` are the triangles of the body without its arms.
    """

    space: BodySpace
    trunk: Triangles
    body_targets: Float[np.ndarray, "k m 3"]
    rows: dict[str, Row]
    civilians: CivilianStatistics
    statistics: SurveyStatistics


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Subject:
    age: float
    traits: Traits
    source_vertices: Float[np.ndarray, "v 3"]
    parameters: Float[np.ndarray, " p"]
    wanted: Float[np.ndarray, " q"]
    reached: Float[np.ndarray, " q"]


def prepare(space: BodySpace, landmarks: SparseRows) -> Workshop:
    """Ready a gender for solving subjects; ``landmarks`` are those of the body model."""
    body_targets = np.ascontiguousarray(space.base.body(space.targets))
    return Workshop(
        space=space,
        trunk=_without_arms(space, body_targets),
        body_targets=body_targets,
        rows=named_rows(space.base, landmarks),
        civilians=load_civilians(packaged_civilians_path(), space.gender),
        statistics=load_statistics(packaged_statistics_path(), space.gender),
    )


def solve_population(
    workshop: Workshop, count: int, seed: int, *, processes: int = 1
) -> Population:
    """Draw and solve ``count`` subjects: about a second each, ``processes`` at a time."""
    streams = np.random.SeedSequence(seed).spawn(count)
    if processes == 1:
        subjects = [_solve(workshop, stream) for stream in streams]
    else:
        # Forked children share the workshop's hundreds of megabytes without copying them.
        _SHARED[processes] = workshop
        with multiprocessing.get_context("fork").Pool(processes) as pool:
            subjects = pool.map(partial(_solve_shared, processes), streams, chunksize=8)
        del _SHARED[processes]
    space = workshop.space
    return Population(
        ages=np.array([subject.age for subject in subjects]),
        ancestries=np.stack([subject.traits.ancestry for subject in subjects]),
        faces=np.stack([subject.traits.face for subject in subjects]),
        source_vertices=np.stack([subject.source_vertices for subject in subjects]),
        parameters=np.stack([subject.parameters for subject in subjects]),
        parameter_names=space.parameter_names,
        wanted=np.stack([subject.wanted for subject in subjects]),
        reached=np.stack([subject.reached for subject in subjects]),
        measurement_names=MEASUREMENTS,
    )


def draw_traits(age: float, generator: np.random.Generator) -> Traits:
    """Appearance at an age in years, ancestry and face of a subject."""
    face = FACE_SPREAD * generator.normal(size=len(FACE_CHANGES))
    return Traits(
        age=age_of_appearance(age),
        ancestry=generator.dirichlet(np.ones(3)),
        face=np.clip(face, -1.0, 1.0),
    )


_KEPT = [field.name for field in fields(Population) if field.name != "source_vertices"]
"""Fields that a file keeps: the vertices follow from the rest."""


def population_path(folder: Path, gender: str, seed: int) -> Path:
    """File of the population of a gender and a seed in a folder."""
    return folder / f"population_{gender}_{seed}.npz"


def save_population(path: Path, population: Population) -> None:
    """Write a population to an ``.npz``, without its vertices, which follow from the rest."""
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(path, **{name: getattr(population, name) for name in _KEPT})


def load_population(path: Path, space: BodySpace, *, count: int | None = None) -> Population:
    """Read the first ``count`` subjects that :func:`save_population` wrote, or all of them.

    Raises
    ------
    ValueError
        If the file was solved in a space of other parameters.
    """
    with np.load(path, allow_pickle=False) as archive:
        content = {name: archive[name] for name in _KEPT}
    for name in ("parameter_names", "measurement_names"):
        content[name] = tuple(content[name].tolist())
    if content["parameter_names"] != space.parameter_names:
        message = f"{path.name} was solved with other parameters than the training now has"
        raise ValueError(message)
    for name in ("ages", "ancestries", "faces", "parameters", "wanted", "reached"):
        content[name] = content[name][:count]
    bodies = [
        source_vertices(
            space,
            Traits(age=age_of_appearance(float(age)), ancestry=ancestry, face=face),
            parameters,
        ).astype(np.float32)
        for age, ancestry, face, parameters in zip(
            content["ages"],
            content["ancestries"],
            content["faces"],
            content["parameters"],
            strict=True,
        )
    ]
    return Population(source_vertices=np.stack(bodies), **content)


def _without_arms(space: BodySpace, body_targets: Float[np.ndarray, "k m 3"]) -> Triangles:
    """The triangles of which no corner moves when the upper arm is lengthened."""
    change = [change.name for change in space.changes].index("measure-upperarm-length")
    motion = np.linalg.norm(body_targets[len(space.macro.names) + 2 * change], axis=1)
    arm = motion > ARM_MOTION * motion.max()
    return space.base.triangles[~arm[space.base.triangles].any(axis=1)]


_SHARED: dict[int, Workshop] = {}
"""Handed to forked children by being there when they are forked."""


def _solve_shared(key: int, stream: np.random.SeedSequence) -> _Subject:
    return _solve(_SHARED[key], stream)


def _solve(workshop: Workshop, stream: np.random.SeedSequence) -> _Subject:
    generator = np.random.default_rng(stream)
    space, statistics = workshop.space, workshop.statistics
    civilian = draw_civilian(workshop.civilians, generator)
    drawn = draw_measurements(statistics, civilian, generator)
    traits = draw_traits(civilian.age, generator)
    spread = np.where(space.neutral == 0.0, LOCAL_SPREAD, MACRO_SPREAD)
    spread[space.parameter_names.index("muscle")] = MUSCLE_SPREAD
    centre = space.neutral + CENTRE_SHARE * spread * generator.normal(size=len(spread))
    tolerance = [(LOOSE | TIGHTER).get(name, TIGHT) for name in MEASUREMENTS]
    wanted = Wanted(
        measurements=on_the_model(MEASUREMENTS, space.gender, drawn),
        tolerance=np.array(tolerance) * statistics.deviation,
        centre=np.clip(centre, space.lower, space.upper),
        spread=spread,
    )
    parameters = space.neutral
    for _ in range(PLACEMENTS):
        placed = _placed(workshop, traits, parameters)
        parameters = fit_subject(placed, wanted, parameters)
    reached, _ = measured(_placed(workshop, traits, parameters), parameters)
    return _Subject(
        age=civilian.age,
        traits=traits,
        source_vertices=source_vertices(space, traits, parameters).astype(np.float32),
        parameters=parameters,
        wanted=wanted.measurements,
        reached=reached,
    )


def _placed(workshop: Workshop, traits: Traits, parameters: Float[np.ndarray, " p"]) -> Placed:
    """The cuts placed on the body of these parameters."""
    space = workshop.space
    body = source_vertices(space, traits, parameters)
    forms = place_measurements(space.base, workshop.trunk, workshop.rows, body)
    return place(space, traits, forms, workshop.body_targets)
