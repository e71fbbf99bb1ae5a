"""A person cut off at the hips, and four limb points: the legs are not seen."""

import cv2
import numpy as np
import pytest

from fitter.body.model import regress
from fitter.fits.pipeline import fit
from fitter.request import Cues
from fitter.result import FitResult
from fitter.vocabulary.outcomes import Verdict
from fitter.vocabulary.remarks import Code, Severity
from tests.accuracy.cases import CASES
from tests.accuracy.files import CaseFiles, read_case
from tests.accuracy.landmark_points import packaged_model
from tests.accuracy.true_picture import fit_request
from tests.one_picture import changed

pytestmark = pytest.mark.slow

SEEN = {"left_shoulder", "right_shoulder", "left_hip", "right_hip"}
FACE = {"nose", "left_eye", "right_eye"}


@pytest.fixture(scope="module")
def files() -> CaseFiles:
    return read_case(CASES["woman_young_thin_standing"])


@pytest.fixture(scope="module")
def cut_off(files: CaseFiles) -> FitResult:
    request = fit_request(files, Cues.SE)
    (view,) = request.views
    below = max(view.clicks[name].y for name in ("left_hip", "right_hip"))
    picture = cv2.imdecode(np.frombuffer(files.image, np.uint8), cv2.IMREAD_COLOR)
    cropped = cv2.imencode(".png", picture[: int(below) + 40])[1].tobytes()
    clicks = {name: at for name, at in view.clicks.items() if name in SEEN | FACE}
    return fit(changed(request, image=cropped, clicks=clicks, force=False))


def test_the_trunk_is_measured_and_the_finding_widens_it(files, cut_off):
    assert cut_off.found.verdict is Verdict.PLAUSIBLE
    (found,) = [each for each in cut_off.views[0].findings if each.code == Code.CUT_OFF]
    assert found.severity is Severity.HARMS
    measured = {each.name: each for each in cut_off.measurements}
    for name in ("chest_girth", "waist_girth_smallest", "hip_girth", "weight"):
        each = measured[name]
        assert each.standard_error is not None
        assert abs(each.value - files.document["truth"][name]) < 2.5 * each.standard_error


def test_legs_that_are_not_seen_stand_straight_below(cut_off):
    model = packaged_model(cut_off.person.gender)
    joints = regress(model.joint_regressor, cut_off.found.posed_vertices)
    at = dict(zip(model.part_names, joints, strict=True))
    for side in ("left", "right"):
        thigh, shin = (
            at[f"{side}_{end}"] - at[f"{side}_{start}"]
            for start, end in (("thigh", "shin"), ("shin", "foot"))
        )
        for limb in (thigh, shin):
            # The camera's second axis points down.
            assert limb[1] / np.linalg.norm(limb) > np.cos(np.radians(25.0))
