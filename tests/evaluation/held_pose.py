"""Fits whose pose is held: what is left is place, shape and light.

The fitter has no such option, and needs none: here its pose prior is narrowed about the pose
to half a degree a joint, and the search begins there. Where the root joint lies, and with it how
large the body appears, stays to be found, unless its place is held too: then no step moves it.
"""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from typing import Any
from unittest.mock import patch

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from fitter.arrays import Pose
from fitter.body.pose_prior import PosePrior, joint_angles
from fitter.energies.objective import Candidate, Objective
from fitter.fits import equipment, outlined
from fitter.fits.prepared_model import PreparedModel
from fitter.optimizer import joint_equations, uncertainty
from fitter.optimizer.normal_equations import Matrix, Vector, normal_equations
from fitter.pose_init.initial_pose import InitialPose, PoseHypothesis
from tests.evaluation.people import load_person
from tests.evaluation.people_table import PEOPLE
from tests.evaluation.scene import Case
from tests.evaluation.staging import Staged, stage
from tests.evaluation.truth import true_joints

HELD_WITHIN_RADIANS = np.radians(0.5)

HELD_PLACE = 1e12
"""Nats per square metre: a place known to a thousandth of a millimetre."""

_BODY_TO_CAMERA_AXES = np.diag([1.0, -1.0, -1.0])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeldBody:
    """A pose to hold, and where the root joint is sought first, or held too.

    ``place`` (3,) camera frame, metres.
    """

    pose: Pose
    place: Float[np.ndarray, "3"]
    place_held: bool = False


def true_pose(staged: Staged) -> Pose:
    """(p, 3) the stance as the fitter writes it: the root turns the body before the camera."""
    pose = staged.pose.copy()
    turned = _BODY_TO_CAMERA_AXES @ staged.to_camera @ Rotation.from_rotvec(pose[0]).as_matrix()
    pose[0] = Rotation.from_matrix(turned).as_rotvec()
    return pose


def held_body_of(case: Case) -> HeldBody:
    """The true pose and place of a case's person."""
    staged = stage(load_person(PEOPLE[case.person]), case)
    return HeldBody(pose=true_pose(staged), place=true_joints(staged)[0])


@contextmanager
def held_at(held: HeldBody) -> Iterator[None]:
    """Within it, :func:`fitter.fits.pipeline.fit` holds this pose."""
    pose, place = held.pose, held.place
    find_body, find_pose = equipment.prepared_model, outlined.initialize_pose

    def body(*arguments: Any, **options: Any) -> PreparedModel:
        found = find_body(*arguments, **options)
        assert found.searched.whole is not None
        operators, searched = (
            replace(each, pose_prior=narrowed(each.pose_prior, pose))
            for each in (found.operators, found.searched)
        )
        whole = replace(found.searched.whole, operators=operators)
        return replace(found, operators=operators, searched=replace(searched, whole=whole))

    def initial(*arguments: Any, **options: Any) -> InitialPose:
        found = find_pose(*arguments, **options)
        parameters = replace(found.parameters, pose=pose, translation=place)
        only: PoseHypothesis = replace(found.hypotheses[0], parameters=parameters)
        return replace(
            found, parameters=parameters, hypotheses=(only,), root_depth_m=float(place[2])
        )

    with ExitStack() as patched:
        patched.enter_context(patch.object(equipment, "prepared_model", body))
        patched.enter_context(patch.object(outlined, "initialize_pose", initial))
        if held.place_held:
            for module in (joint_equations, uncertainty):
                patched.enter_context(patch.object(module, "normal_equations", without_moves))
        yield


def without_moves(
    objective: Objective, candidate: Candidate, *, marginal: bool = False
) -> tuple[Matrix, Vector]:
    """Normal equations whose steps leave the root joint where it is: nothing else moves with it."""
    matrix, gradient = normal_equations(objective, candidate, marginal=marginal)
    first = candidate.parameters.pose.size
    place = np.arange(first, first + 3)
    matrix[place], matrix[:, place], gradient[place] = 0.0, 0.0, 0.0
    matrix[place, place] = HELD_PLACE
    return matrix, gradient


def narrowed(prior: PosePrior, pose: Pose) -> PosePrior:
    """A prior that expects this pose of every joint, the root too, and knows no limits."""
    return replace(
        prior,
        mean=joint_angles(prior, pose),
        precision=np.full_like(prior.precision, 1.0 / HELD_WITHIN_RADIANS),
        lower=np.full_like(prior.lower, -np.inf),
        upper=np.full_like(prior.upper, np.inf),
    )
