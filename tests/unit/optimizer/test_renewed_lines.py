"""Searches whose lines follow the body, on a person before a wall whose mask is faulty."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from fitter.arrays import Image, Mask
from fitter.energies.objective import Body, Candidate, Objective
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.optimizer.search import body_search, with_lines_about
from fitter.vocabulary.choices import OptimizerKind
from tests.unit.optimizer.rendered_scene import RenderedScene, of_person, rendered_scene

WALL = np.array([0.15, 0.3, 0.45])
KEPT_PX = 6
"""Of wall, beside the person's whole right side."""


def ignore(_):
    """Observe nothing."""


def searched(objective: Objective, start: Body) -> Candidate:
    """Where a search of the picture ends."""
    search = body_search(OptimizerKind.GAUSS_NEWTON, 30, ignore)
    (found,) = search(of_person(objective), [start]).candidate.views
    return found


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Misled:
    """A scene with a faulty mask, the body a search made of it, and what is to be seen."""

    scene: RenderedScene
    body: Candidate
    person: Mask
    display: Image

    def overlap(self, found: Candidate) -> float:
        """Intersection over union with the person."""
        body = found.rendering.silhouette
        return float((body & self.person).sum() / (body | self.person).sum())


@pytest.fixture(scope="module")
def misled() -> Misled:
    sound = rendered_scene(3)
    evidence = sound.objective.evidence
    person = evidence.silhouette.mask
    mask = person.copy()
    for row in range(len(mask)):
        columns = np.flatnonzero(mask[row])
        if len(columns):
            mask[row, columns[-1] : columns[-1] + KEPT_PX] = True
    shown = np.where(person[..., None], 0.25 + 0.7 * sound.display, WALL)
    noise = np.random.default_rng(0).standard_normal(shown.shape)
    faulty = replace(evidence, silhouette=silhouette_evidence(mask))
    scene = replace(sound, objective=replace(sound.objective, evidence=faulty))
    return Misled(
        scene=scene,
        body=searched(scene.objective, scene.start),
        person=person,
        display=(shown + 0.01 * noise).astype(np.float32),
    )


def test_lines_find_the_person_where_the_mask_has_kept_the_wall(misled):
    found = misled.body
    for _ in range(2):
        found = searched(with_lines_about(misled.scene.objective, found, misled.display), found)
    wrong, left = (1.0 - misled.overlap(each) for each in (misled.body, found))
    assert wrong > 0.06
    assert left < 0.5 * wrong


def test_lines_are_laid_out_about_the_body(misled):
    lines = with_lines_about(misled.scene.objective, misled.body, misled.display).evidence.lines
    projected = misled.body.rendering.projected
    np.testing.assert_allclose(lines.centres, projected[lines.points].mean(axis=1))


def test_lines_take_the_place_of_the_region(misled):
    objective, truth = misled.scene.objective, misled.scene.truth
    lined = with_lines_about(objective, truth, misled.display)
    by_region, by_lines = (
        each.evaluate(truth).energies["silhouette"] for each in (objective, lined)
    )
    # To the lines the true body is right; to the faulty mask it is not.
    assert by_lines < 0.1 * by_region
