from dataclasses import replace

import numpy as np
import pytest

from fitter.body.pose_prior import prior_residuals
from fitter.energies.attributes import NOTHING_KNOWN
from fitter.energies.fitting_operators import fitting_operators
from fitter.fits.equipment import Equipment
from fitter.fits.prepared_model import prepared_model
from fitter.optimizer.free_space import free_space
from fitter.optimizer.joint_equations import joint_equations
from fitter.parameters import BodyParameters
from fitter.vocabulary.choices import Gender
from tests.evaluation.cases import CASES, DEMO
from tests.evaluation.held_pose import HELD_WITHIN_RADIANS, HeldBody, held_at, narrowed, true_pose
from tests.evaluation.people import load_person
from tests.evaluation.people_table import PEOPLE
from tests.evaluation.shape_limit import nearest_shape
from tests.evaluation.staging import root_joint, stage
from tests.unit.optimizer.rendered_scene import rendered_scene
from tests.unit.training.makehuman_data import needs_makehuman

pytestmark = needs_makehuman


@pytest.mark.parametrize("name", ["demo", "woman_old_heavy_turned", "man_young_thin_occluded"])
def test_the_fitters_body_in_the_true_pose_lies_on_the_true_body(name):
    case = DEMO if name == "demo" else CASES[name]
    person = load_person(PEOPLE[case.person])
    staged = stage(person, case)
    parameters = BodyParameters(
        pose=true_pose(staged),
        translation=staged.in_camera(root_joint(staged)),
        shape=nearest_shape(person),
    )
    vertices = prepared_model(person.gender).operators.evaluator.vertices(parameters)
    away = vertices - staged.in_camera(staged.body)
    # The root joints of rig and model are a centimetre or two apart; fingers are not posed alike.
    assert np.median(np.linalg.norm(away - np.median(away, axis=0), axis=1)) < 0.01


def test_a_narrowed_prior_expects_one_pose_of_every_joint():
    prior = fitting_operators(prepared_model(PEOPLE[DEMO.person].gender).operators.model).pose_prior
    pose = np.random.default_rng(0).normal(scale=0.4, size=prior.mean.shape)
    narrow = narrowed(prior, pose)
    assert np.allclose(prior_residuals(narrow, pose), 0.0)
    turned = pose.copy()
    turned[0, 1] += HELD_WITHIN_RADIANS
    assert np.linalg.norm(prior_residuals(narrow, turned)) == pytest.approx(1.0)


def test_a_held_pose_is_expected_by_the_body_that_is_searched_and_by_the_whole_one():
    pose = np.random.default_rng(0).normal(scale=0.4, size=rendered_scene(0).start.pose.shape)
    with held_at(HeldBody(pose=pose, place=np.array([0.0, 0.0, 3.0]))):
        held = Equipment().model(Gender.MALE)
    assert held.searched.whole is not None
    for each in (held.searched, held.operators, held.searched.whole.operators):
        assert np.allclose(prior_residuals(each.pose_prior, pose), 0.0)
        assert np.all(each.pose_prior.precision == 1.0 / HELD_WITHIN_RADIANS)


def test_a_held_place_leaves_pose_and_shape_free():
    scene = rendered_scene(0)
    candidate = scene.person.evaluate([scene.start])
    space = free_space(NOTHING_KNOWN.held, candidate.shape)
    pose = HeldBody(pose=scene.start.pose, place=scene.start.translation)
    steps = []
    for held in (pose, replace(pose, place_held=True)):
        with held_at(held):
            steps.append(joint_equations(scene.person, candidate, space).step(0.01))
    (free,), (kept,) = (step.own for step in steps)
    assert np.abs(free[-3:]).max() > 1e-3
    assert np.abs(kept[-3:]).max() < 1e-9
    assert np.abs(kept[:-3]).max() > 1e-2
    assert np.abs(steps[1].shape).max() > 1e-2
