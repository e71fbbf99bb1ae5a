"""A fit of one to six pictures of a person: one shape, a body in each, and faults by name."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.detection.detector import installed_detector
from fitter.errors import InvalidInputError
from fitter.fits.capture_check import CaptureQuestion
from fitter.fits.pipeline import fit
from fitter.fits.progress import Progress, Stage
from fitter.fits.proposal import propose
from fitter.request import FitRequest, KnownMeasurement, View
from fitter.result import FitResult, before_shading
from fitter.vocabulary.choices import Cues, OptimizerKind, SegmentationKind, ViewKind
from fitter.vocabulary.outcomes import Verdict
from fitter.vocabulary.remarks import Code
from tests.accuracy.cases import CASES, PHONE_PAIRS
from tests.accuracy.files import read_case
from tests.accuracy.runs import picture_of
from tests.accuracy.spoilt import Asked, spoilt_request
from tests.accuracy.true_picture import fit_request
from tests.benchmarks.requests import resized
from tests.one_picture import changed, together

STANDING, TURNED = "woman_young_heavy_standing", "woman_young_heavy_turned"
SOMEBODY_ELSE = "woman_young_thin_turned"


def asked(
    name: str,
    kind: ViewKind | None = None,
    cues: Cues = Cues.SE,
    size: tuple[int, int] = (300, 400),
) -> FitRequest:
    width, height = size
    request = resized(fit_request(read_case(CASES[name]), cues), width=width, height=height)
    return changed(request, kind=kind, force=False)


def warned(result: FitResult) -> list[str]:
    """What the whole fit warns of."""
    return [each.code for each in result.warnings]


@pytest.fixture(scope="module")
def of_two() -> tuple[FitResult, list[Progress]]:
    reports: list[Progress] = []
    request = together(asked(STANDING, ViewKind.FRONT), asked(TURNED, cues=Cues.SES))
    return fit(request, observer=reports.append), reports


@pytest.fixture(scope="module")
def turned() -> FitResult:
    return fit(asked(STANDING, ViewKind.SIDE))


@pytest.fixture(scope="module")
def of_one() -> tuple[FitResult, list[Progress]]:
    reports: list[Progress] = []
    return fit(asked(STANDING, ViewKind.FRONT), observer=reports.append), reports


def test_all_views_show_one_shape_in_poses_of_their_own(of_two):
    result, _ = of_two
    assert [each.kind for each in result.views] == [ViewKind.FRONT, None]
    for each in result.views:
        person = each.found.person
        np.testing.assert_array_equal(person.body.shape, result.shape)
        np.testing.assert_allclose(person.shape_covariance, result.shape_covariance, atol=1e-9)
        assert each.found.silhouette_overlap > 0.9
        assert each.found.is_plausible
        assert each.limb_facing
    one, other = (each.found.person.body.pose for each in result.views)
    assert np.abs(one - other).max() > 0.1


def test_one_picture_is_the_same_kind_of_result(of_one):
    result, _ = of_one
    (view,) = result.views
    assert result.found is view.found
    assert result.alone is None
    assert view.found.silhouette_overlap > 0.9
    assert result.canonical_vertices.shape == view.found.posed_vertices.shape
    assert result.triangles.max() == len(result.canonical_vertices) - 1
    measured = {each.name: each.value for each in result.measurements}
    assert measured["stature"] == pytest.approx(100.0 * view.found.height_m, abs=0.1)


def test_light_is_found_in_the_views_that_ask_for_it(of_two):
    result, _ = of_two
    lights = [each.found.person.light for each in result.views]
    assert lights[0] is None
    assert lights[1] is not None
    assert result.views[1].found.person.albedo_rgb is not None


def test_stages_hold_a_body_of_one_shape_in_every_picture(of_one, of_two):
    assert [stage.name for stage in of_one[0].stages] == ["initial", "SE"]
    result, _ = of_two
    assert [stage.name for stage in result.stages] == ["initial", "SE", "SES"]
    for stage in result.stages:
        one, other = stage.bodies
        np.testing.assert_array_equal(one.body.shape, other.body.shape)
        assert stage.energies["silhouette"] > 0.0
        assert {each.name for each in stage.measurements} >= {"stature", "weight"}
    first, _, last = result.stages
    for before, after in zip(first.bodies, last.bodies, strict=True):
        assert before.silhouette_overlap < after.silhouette_overlap
    assert sum(last.energies.values()) == pytest.approx(sum(result.energies.values()))


def test_before_shading_every_view_is_as_its_outline_left_it(of_one, of_two):
    assert before_shading(of_one[0]) is None
    result, _ = of_two
    before = before_shading(result)
    assert before is not None
    stage = result.stages[1]
    np.testing.assert_array_equal(before.shape, stage.bodies[0].body.shape)
    for view, body in zip(before.views, stage.bodies, strict=True):
        assert view.found.cues is Cues.SE
        assert view.found.person.light is None
        np.testing.assert_array_equal(view.found.posed_vertices, body.posed_vertices)


def test_a_picture_from_another_side_than_announced_withholds_measurements(turned):
    assert "other-view" in {each.code for each in turned.views[0].findings}
    assert turned.found.verdict is Verdict.IMPLAUSIBLE
    assert turned.measurements == ()
    assert "other-view: " in turned.found.outcome_explanation
    assert "Have the person turn" in turned.found.outcome_explanation


def test_a_box_before_the_hips_is_told(of_one):
    """Of the same picture without it nothing is."""
    kind = "box before the hips"
    how = Asked(picture=STANDING, other=TURNED, kind=kind, proposed=False, seed=0)
    request = resized(spoilt_request(picture_of(STANDING), how), width=300, height=400)
    findings = {each.code: each for each in fit(request).views[0].findings}
    assert "100 % at the hips" in findings[Code.COVERED].reason
    assert Code.COVERED not in {each.code for each in of_one[0].views[0].findings}


@pytest.mark.parametrize(("spread_m", "is_told"), [(None, False), (0.03, True)])
def test_proposals_that_are_sent_back_are_no_clicks(spread_m, is_told):
    """Before somebody else the detector's points go astray."""
    who, other = "man_middle_aged_middling_standing", "woman_young_thin_standing"
    how = Asked(picture=who, other=other, kind="neighbour behind", proposed=False, seed=0)
    request = changed(spoilt_request(picture_of(who), how), cues=Cues.SE)
    clicks = {
        name: replace(click, spread_m=spread_m) for name, click in request.views[0].clicks.items()
    }
    findings = {each.code for each in fit(changed(request, clicks=clicks)).views[0].findings}
    assert (Code.SEVERAL_PEOPLE in findings) is is_told


@pytest.mark.slow
def test_a_belly_that_the_first_body_does_not_reach_is_the_persons_own():
    """It stood so far off that body that the whole of it was doubted."""
    pair = PHONE_PAIRS["phone_man_old_heavy"]
    front, side = picture_of(pair.front.name), picture_of(pair.side.name)
    found = fit(
        together(
            changed(front.request, kind=ViewKind.FRONT, cues=Cues.SE),
            changed(side.request, kind=ViewKind.SIDE, cues=Cues.SE),
        )
    )
    assert Code.COVERED not in {each.code for view in found.views for each in view.findings}
    waist = {each.name: each.value for each in found.measurements}["waist_girth_smallest"]
    assert waist == pytest.approx(side.truth.measurements["waist_girth_smallest"], abs=4.0)


@pytest.mark.parametrize("segmentation", SegmentationKind)
def test_every_picture_is_checked_as_before_a_fit(segmentation):
    """Without a detector by the clicks."""
    request = changed(asked(STANDING, ViewKind.SIDE), segmentation=segmentation, slant_hints=False)
    (view,), person = request.views, request.person
    found = fit(request).views[0].findings
    detector = installed_detector() if segmentation is SegmentationKind.SEEDED_GRABCUT else None
    question = CaptureQuestion(
        view=view.kind, points=view.clicks, gender=person.gender, height_m=person.height_m
    )
    alone = propose(view.image, question, detector=detector, max_pixels=1_000_000)
    assert {each.code for each in found} == {each.code for each in alone.checked.findings}
    assert "other-view" in {each.code for each in found}


def test_the_measurements_are_more_certain_than_those_of_one_picture(of_one, of_two):
    alone = {each.name: each for each in of_one[0].measurements}
    for each in of_two[0].measurements:
        if each.name in ("waist_girth_navel", "chest_girth", "hip_girth", "weight"):
            assert each.standard_error < alone[each.name].standard_error
    assert "stature" in of_two[0].given


def test_progress_names_the_view_and_never_goes_back(of_two):
    result, reports = of_two
    assert (np.diff([each.fraction for each in reports]) >= 0.0).all()
    numbers = [each.view for each in reports if each.stage is not Stage.OBSERVATION]
    assert list(dict.fromkeys(numbers)) == [0, 1, None]
    assert {Stage.OBSERVATION, Stage.SILHOUETTE_AND_EDGES} <= {
        each.stage for each in reports if each.view == 1
    }
    assert result.stage_seconds.keys() == {each.stage.value for each in reports}


def test_a_fit_of_one_picture_never_speaks_of_its_place(of_one, turned):
    result, reports = of_one
    assert {each.view for each in reports} == {None}
    assert (np.diff([each.fraction for each in reports]) >= 0.0).all()
    (warning,) = turned.warnings
    assert warning.code == "other-view"
    assert warning.reason.startswith("The picture is said to be from the side")
    said = [each.reason for each in (*result.warnings, *turned.warnings)]
    said += [each.reason for view in turned.views for each in view.warnings]
    assert not any("views" in each for each in said)


@pytest.mark.parametrize("count", [0, 7])
def test_too_few_and_too_many_views_are_refused(count):
    views = asked(STANDING).views * count
    with pytest.raises(InvalidInputError, match="1 to 6") as caught:
        fit(replace(asked(STANDING), views=views))
    assert (caught.value.code, caught.value.field) == ("views-count", "views")


def broken(request: FitRequest) -> View:
    (view,) = request.views
    return replace(view, image=view.image[:2000])


def test_a_view_that_cannot_be_used_is_named():
    sound, other = asked(STANDING), asked(TURNED)
    with pytest.raises(InvalidInputError) as caught:
        fit(replace(sound, views=(*sound.views, broken(other))))
    assert caught.value.field == "views.1.image"
    assert caught.value.code.startswith("image-")


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize(
    ("said", "field"),
    [
        ({"height_m": 3.0}, "height_m"),
        ({"measurements": {"weight": KnownMeasurement(value=-1.0)}}, "measurements.weight"),
        ({"measurements": {"weight": KnownMeasurement(value=900.0)}}, "measurements.weight"),
    ],
)
def test_a_fault_of_the_person_is_nobody_elses(count, said, field):
    request = changed(together(*[asked(STANDING)] * count), **said)
    with pytest.raises(InvalidInputError) as caught:
        fit(request)
    assert caught.value.field == field


def test_views_of_different_people_are_told():
    result = fit(together(asked(STANDING), asked(SOMEBODY_ELSE)))
    assert warned(result) == ["different-people"]
    assert result.alone is not None
    assert result.alone.doubtful


@pytest.mark.parametrize(
    "names", [pytest.param((STANDING,), marks=pytest.mark.slow), (STANDING, TURNED)]
)
def test_a_weight_that_was_given_is_held(names):
    known = {"weight": KnownMeasurement(value=78.0)}
    result = fit(changed(together(*map(asked, names)), measurements=known))
    assert warned(result) == []
    weight = next(each for each in result.measurements if each.name == "weight")
    assert weight.value == pytest.approx(78.0, abs=0.01)
    assert weight.standard_error == 0.0


@pytest.mark.parametrize(
    "names", [(STANDING,), pytest.param((STANDING, TURNED), marks=pytest.mark.slow)]
)
def test_a_weight_that_the_pictures_contradict_is_named(names):
    known = {"weight": KnownMeasurement(value=45.0)}
    result = fit(changed(together(*map(asked, names)), measurements=known))
    (warning,) = result.warnings
    assert warning.code == "given-contradicted"
    assert warning.reason.startswith("weight was given as 45.0 kg, but")


def test_left_and_right_of_a_mirrored_picture_are_doubted():
    request = asked(STANDING, ViewKind.FRONT)
    swapped = {
        name.replace("left", "?").replace("right", "left").replace("?", "right"): click
        for name, click in request.views[0].clicks.items()
    }
    assert "other-view" in warned(fit(changed(request, clicks=swapped)))


@pytest.mark.slow
def test_the_simplex_searches_several_pictures_too(monkeypatch):
    from fitter.optimizer import search

    few = replace(
        search.limits_of(OptimizerKind.SIMPLEX), first=10, trial=10, contest=10,
        silhouette_and_edges=150,
    )  # fmt: skip
    monkeypatch.setitem(search._LIMITS, OptimizerKind.SIMPLEX, few)
    request = together(asked(STANDING, size=(105, 140)), asked(TURNED, size=(105, 140)))
    result = fit(changed(request, optimizer=OptimizerKind.SIMPLEX))
    assert result.optimizer is OptimizerKind.SIMPLEX
    assert 300 < result.evaluations < 500
    first, *_, last = result.stages
    assert sum(last.energies.values()) < sum(first.energies.values())
    one, other = (each.found.person.body.shape for each in result.views)
    np.testing.assert_array_equal(one, other)


def test_an_unknown_height_leaves_the_shape_less_certain(of_one):
    unsure = fit(changed(asked(STANDING, ViewKind.FRONT), height_m=None))
    assert unsure.shape_covariance[0, 0] > 0.1
    assert np.trace(unsure.shape_covariance) > np.trace(of_one[0].shape_covariance)
