"""A scan of one person: one shape, bodies in every picture, and what is refused by name."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.errors import InvalidInputError
from fitter.fits.pipeline import fit
from fitter.fits.progress import Stage
from fitter.fits.scan import ScanProgress, ScanResult, ScanView, scan
from fitter.request import Cues, FitRequest, KnownMeasurement, ViewKind
from tests.benchmarks.requests import resized
from tests.evaluation.cases import CASES
from tests.evaluation.files import read_case
from tests.evaluation.suite import fit_request

STANDING, TURNED = "woman_young_heavy_standing", "woman_young_heavy_turned"
SOMEBODY_ELSE = "woman_young_thin_turned"


def asked(name: str, cues: Cues = Cues.SE) -> FitRequest:
    return resized(fit_request(read_case(CASES[name]), cues), width=300, height=400)


def view(name: str, kind: ViewKind = ViewKind.OTHER, cues: Cues = Cues.SE) -> ScanView:
    return ScanView(kind=kind, request=asked(name, cues))


@pytest.fixture(scope="module")
def scanned() -> tuple[ScanResult, list[ScanProgress]]:
    reports: list[ScanProgress] = []
    views = [view(STANDING, ViewKind.FRONT), view(TURNED, cues=Cues.SES)]
    return scan(views, observe=reports.append), reports


def test_all_views_show_one_shape_in_poses_of_their_own(scanned):
    result, _ = scanned
    assert [each.kind for each in result.views] == [ViewKind.FRONT, ViewKind.OTHER]
    for each in result.views:
        np.testing.assert_array_equal(each.found.person.body.shape, result.shape)
        np.testing.assert_allclose(each.found.person.shape_covariance, result.covariance, atol=1e-9)
        assert each.found.silhouette_overlap > 0.9
        assert each.found.is_plausible
    one, other = (each.found.person.body.pose for each in result.views)
    assert np.abs(one - other).max() > 0.1


def test_light_is_found_in_the_views_that_ask_for_it(scanned):
    result, _ = scanned
    lights = [each.found.person.light for each in result.views]
    assert lights[0] is None
    assert lights[1] is not None
    assert result.views[1].found.person.albedo_rgb is not None


def test_the_measurements_are_more_certain_than_those_of_one_picture(scanned):
    result, _ = scanned
    alone = {each.name: each for each in fit(asked(STANDING)).measurements}
    for each in result.measurements:
        if each.name in ("waist_girth_navel", "chest_girth", "hip_girth", "weight"):
            assert each.standard_error < alone[each.name].standard_error
    assert "stature" in result.given


def test_progress_names_the_view_and_never_goes_back(scanned):
    _, reports = scanned
    assert (np.diff([each.fraction for each in reports]) >= 0.0).all()
    numbers = [each.view for each in reports]
    assert list(dict.fromkeys(numbers)) == [0, 1, None]
    assert {Stage.OBSERVATION, Stage.SILHOUETTE_AND_EDGES} <= {
        each.stage for each in reports if each.view == 1
    }


@pytest.mark.parametrize("count", [1, 7])
def test_too_few_and_too_many_views_are_refused(count):
    with pytest.raises(InvalidInputError, match="2 to 6") as caught:
        scan([view(STANDING)] * count)
    assert (caught.value.code, caught.value.field) == ("views-count", "views")


def test_a_view_that_cannot_be_used_is_named():
    broken = replace(asked(TURNED), image=asked(TURNED).image[:2000])
    with pytest.raises(InvalidInputError) as caught:
        scan([view(STANDING), ScanView(kind=ViewKind.SIDE, request=broken)])
    assert caught.value.field == "views.1.image"
    assert caught.value.code.startswith("image-")


@pytest.mark.parametrize(
    "told", [{"height_m": 1.5}, {"measurements": {"weight": KnownMeasurement(value=70.0)}}]
)
def test_views_that_say_different_things_of_the_person_are_refused(told):
    other = ScanView(kind=ViewKind.SIDE, request=replace(asked(TURNED), **told))
    with pytest.raises(InvalidInputError, match="different heights, genders") as caught:
        scan([view(STANDING), other])
    assert (caught.value.code, caught.value.field) == ("views-differ", "views.1")


def test_views_of_different_people_are_told():
    stranger = replace(asked(SOMEBODY_ELSE), height_m=asked(STANDING).height_m)
    result = scan([view(STANDING), ScanView(kind=ViewKind.OTHER, request=stranger)])
    assert [each.code for each in result.warnings] == ["different-people"]
    assert result.alone.agreement < 0.01


def test_a_weight_that_was_given_is_held():
    views = [view(STANDING), view(TURNED)]
    known = {"weight": KnownMeasurement(value=78.0)}
    views = [replace(each, request=replace(each.request, measurements=known)) for each in views]
    result = scan(views)
    assert not result.warnings
    weight = next(each for each in result.measurements if each.name == "weight")
    assert weight.value == pytest.approx(78.0, abs=0.01)
    assert weight.standard_error == 0.0


def test_a_weight_that_the_pictures_contradict_is_named():
    known = {"weight": KnownMeasurement(value=48.0)}
    views = [
        ScanView(kind=ViewKind.OTHER, request=replace(asked(name), measurements=known))
        for name in (STANDING, TURNED)
    ]
    (warning,) = scan(views).warnings
    assert warning.code == "given-contradicted"
    assert warning.message.startswith("weight was given as 48.0 kg, but")


def test_a_view_from_another_side_than_announced_is_named():
    result = scan([view(STANDING, ViewKind.SIDE), view(TURNED)])
    assert [each.code for each in result.warnings] == ["other-view"]
    assert "views.0 is said to be from the side" in result.warnings[0].message
    assert "other-view" in {each.code for each in result.views[0].findings}


def test_left_and_right_of_a_mirrored_picture_are_doubted():
    mirrored = asked(STANDING)
    swapped = {
        name.replace("left", "?").replace("right", "left").replace("?", "right"): click
        for name, click in mirrored.clicks.items()
    }
    views = [
        ScanView(kind=ViewKind.FRONT, request=replace(mirrored, clicks=swapped)),
        view(TURNED),
    ]
    result = scan(views)
    assert {"other-view"} <= {each.code for each in result.warnings}
