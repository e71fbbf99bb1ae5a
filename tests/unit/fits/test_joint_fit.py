"""One shape from several pictures of one person, and the person in each of them."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.errors import InvalidInputError
from fitter.fits.joint_fit import JointFit, joint_fit
from fitter.fits.pipeline import fit
from fitter.person.fitted_person import FittedPerson
from fitter.request import Cues, FitRequest, KnownMeasurement
from tests.benchmarks.requests import resized
from tests.evaluation.cases import CASES
from tests.evaluation.files import read_case
from tests.evaluation.suite import fit_request

PICTURES = ("woman_young_heavy_standing", "woman_young_heavy_turned")


def ignore(_):
    return None


@pytest.fixture(scope="module")
def requests() -> list[FitRequest]:
    asked = [fit_request(read_case(CASES[name]), Cues.SE) for name in PICTURES]
    return [resized(each, width=300, height=400) for each in asked]


@pytest.fixture(scope="module")
def people(requests) -> list[FittedPerson]:
    return [fit(each).person for each in requests]


@pytest.fixture(scope="module")
def joint(people, requests) -> tuple[JointFit, list[float]]:
    done: list[float] = []
    return joint_fit(people, requests, observe=done.append), done


def test_every_picture_has_the_one_shape_in_its_own_pose(joint, people):
    found, _ = joint
    assert len(found.pictures) == len(people)
    for picture, person in zip(found.pictures, people, strict=True):
        np.testing.assert_array_equal(picture.person.body.shape, found.shape)
        assert picture.person.camera == person.camera
        assert picture.silhouette_overlap > 0.9
        away = np.linalg.norm(picture.person.body.translation - person.body.translation)
        assert away < 0.1 * person.body.translation[2]
    one, other = (picture.person.body.pose for picture in found.pictures)
    assert np.abs(one - other).max() > 0.1


def test_the_shape_is_near_what_the_fits_agree_on_and_more_certain(joint, people):
    found, _ = joint
    # In standard deviations, over twenty axes: the pictures are searched again.
    assert np.linalg.norm(found.shape - found.fused.shape) < 0.5 * np.sqrt(len(found.shape))
    for person in people:
        assert np.trace(found.covariance) < np.trace(person.shape_covariance)
    assert found.shape[0] == people[0].body.shape[0]
    assert not found.covariance[0].any()


def test_progress_rises_to_the_end(joint):
    _, done = joint
    assert (np.diff(done) >= 0.0).all()
    assert done[0] > 0.0
    assert done[-1] == 1.0


def test_an_unknown_height_leaves_the_shape_less_certain(people, requests, joint):
    found, _ = joint
    unsure = joint_fit(people, [replace(each, height_m=None) for each in requests], observe=ignore)
    assert unsure.covariance[0, 0] > 0.1
    assert np.trace(unsure.covariance) > np.trace(found.covariance)


@pytest.mark.parametrize(
    "told", [{"height_m": 1.5}, {"measurements": {"weight": KnownMeasurement(value=70.0)}}]
)
def test_fits_that_were_told_different_things_are_refused_by_number(people, requests, told):
    with pytest.raises(InvalidInputError, match="were told different") as caught:
        joint_fit(people, [requests[0], replace(requests[1], **told)], observe=ignore)
    assert (caught.value.code, caught.value.field) == ("fits-unusable", "fits.0")
