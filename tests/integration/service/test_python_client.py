"""The client of this package against a running service."""

import socket
from pathlib import Path

import pytest

from api_schemas.client import Maquette, MaquetteError
from api_schemas.fit import FitRequest
from api_schemas.points import AUTO
from fitter.vocabulary.choices import Gender
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import Service

KNOWN = {"gender": "female", "height_m": 1.68, "points": "auto"}
SCAN = {"gender": "female", "views": [{"view": "front"}, {"view": "side"}]}


@pytest.fixture
def maquette(service: Service):
    with Maquette(str(service.client.base_url)) as client:
        yield client


def test_a_picture_is_sent_waited_for_and_measured(maquette: Maquette, tmp_path: Path):
    picture = tmp_path / "picture.png"
    picture.write_bytes(scripted_image())
    job = maquette.wait_for(maquette.fit(picture, KNOWN))
    result = maquette.result(job)
    assert (result.height_m, result.stages) == (1.68, ())
    assert len(maquette.result(job, stages=True).stages) == 1
    assert maquette.artifact(job, "body_posed.glb").startswith(b"glTF")
    maquette.erase(job)
    with pytest.raises(MaquetteError) as gone:
        maquette.result(job)
    assert gone.value.status == 404


def test_a_request_may_be_of_the_packages_own_type_and_have_a_mask(maquette: Maquette):
    asked = FitRequest(gender=Gender.FEMALE, height_m=1.7, points=AUTO)
    job = maquette.fit(scripted_image(), asked, mask=scripted_image())
    assert job.links.mask is not None


def test_a_string_is_the_path_of_a_file(maquette: Maquette, tmp_path: Path):
    picture = tmp_path / "picture.png"
    picture.write_bytes(scripted_image())
    assert maquette.wait_for(maquette.fit(str(picture), KNOWN, mask=str(picture))).links.mask


def test_who_does_not_answer_is_named():
    with socket.socket() as bound:  # to a port where nothing listens
        bound.bind(("127.0.0.1", 0))
        address = f"http://127.0.0.1:{bound.getsockname()[1]}"
        with Maquette(address) as client, pytest.raises(MaquetteError, match=address) as away:
            client.fit(b"", KNOWN)
    assert (away.value.status, away.value.problem) == (None, None)


def test_two_pictures_are_one_scan(maquette: Maquette):
    scan = maquette.wait_for(maquette.scan([scripted_image(), scripted_image({"n": 1})], SCAN))
    assert [view.view for view in maquette.result(scan).views] == ["front", "side"]


def test_a_scan_may_have_a_mask_of_one_picture(maquette: Maquette):
    pictures = [scripted_image(), scripted_image({"n": 1})]
    scan = maquette.scan(pictures, SCAN, masks=[None, scripted_image()])
    assert [each.mask is not None for each in scan.links.views] == [False, True]


def test_what_is_sent_again_with_its_key_is_the_same_job(maquette: Maquette):
    first, again = (
        maquette.fit(scripted_image(), KNOWN, idempotency_key="as before") for _ in range(2)
    )
    assert first.id == again.id
    assert maquette.fit(scripted_image(), KNOWN).id != first.id


def test_who_waits_longer_than_an_answer_does_is_told_how_far_it_is(
    maquette: Maquette, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("api_schemas.client.WAIT_S", 0)
    seen: list[str] = []
    job = maquette.fit(scripted_image({"seconds": 0.5}), KNOWN)
    maquette.wait_for(job, on_progress=lambda each: seen.append(each.state))
    assert seen


def test_what_is_refused_or_has_failed_says_what_to_do(maquette: Maquette):
    with pytest.raises(MaquetteError, match="height") as refused:
        maquette.fit(scripted_image(), KNOWN | {"height_m": 9})
    assert refused.value.problem is not None
    assert refused.value.problem.errors[0].field == "height_m"
    job = maquette.fit(scripted_image({"unusable": True}), KNOWN)
    with pytest.raises(MaquetteError, match="Send the whole file"):
        maquette.wait_for(job)
