"""The client of this package against a running service."""

import socket
from pathlib import Path

import pytest

from api_schemas.client import Maquette, MaquetteError
from api_schemas.fit import FitRequest
from api_schemas.products.bodies import CaricatureOptions
from fitter.vocabulary.choices import Gender
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import Service
from tests.integration.service.test_products import BVH

KNOWN = {"gender": "female", "height_m": 1.68}
SEVERAL = {"gender": "female", "views": [{"view": "front"}, {"view": "side"}]}


@pytest.fixture
def maquette(service: Service):
    with Maquette(str(service.client.base_url)) as client:
        yield client


def test_a_picture_is_fitted_and_measured(maquette: Maquette, tmp_path: Path):
    picture = tmp_path / "picture.png"
    picture.write_bytes(scripted_image())
    seen: list[str | None] = []
    fit = maquette.fit(KNOWN, picture, on_progress=lambda each: seen.append(each.stage))
    assert {"segmentation", "measurement"} <= set(seen)
    result = maquette.result(fit)
    assert (result.height_m, len(result.stages)) == (1.68, 1)
    assert maquette.file(fit, "body_canonical.glb").startswith(b"glTF")
    maquette.erase(fit)
    with pytest.raises(MaquetteError) as gone:
        maquette.result(fit)
    assert gone.value.status == 404


def test_a_product_is_made_and_its_files_are_read(maquette: Maquette):
    fit = maquette.fit(KNOWN, scripted_image())
    posed = maquette.product(fit, {"kind": "pose"})
    assert maquette.file(posed, "body_reposed.glb").startswith(b"glTF")
    moved = maquette.product(fit, {"kind": "animation"}, bvh=BVH.encode())
    assert moved.kind == "animation"
    with pytest.raises(MaquetteError, match="Send a factor") as refused:
        maquette.product(fit, CaricatureOptions(kind="caricature", factor=7.0))
    assert refused.value.problem is not None
    assert refused.value.problem.field == "factor"


def test_a_request_may_be_of_the_packages_own_type_and_have_a_mask(maquette: Maquette):
    asked = FitRequest(gender=Gender.FEMALE, height_m=1.7)
    fit = maquette.fit(asked, scripted_image(), masks=[scripted_image()])
    assert "views/0/mask" in fit.links.files


def test_who_does_not_answer_is_named():
    with socket.socket() as bound:  # to a port where nothing listens
        bound.bind(("127.0.0.1", 0))
        address = f"http://127.0.0.1:{bound.getsockname()[1]}"
        with Maquette(address) as client, pytest.raises(MaquetteError, match=address) as away:
            client.fit(KNOWN, b"")
    assert (away.value.status, away.value.problem) == (None, None)


def test_two_pictures_are_one_fit(maquette: Maquette):
    fit = maquette.fit(SEVERAL, scripted_image(), scripted_image({"n": 1}))
    assert [view.view for view in maquette.result(fit).views] == ["front", "side"]


def test_what_is_sent_again_with_its_key_is_the_same_fit(maquette: Maquette):
    first, again = (
        maquette.fit(KNOWN, scripted_image(), idempotency_key="as before") for _ in range(2)
    )
    assert first.id == again.id
    assert maquette.fit(KNOWN, scripted_image()).id != first.id


def test_what_is_refused_or_has_failed_says_what_to_do(maquette: Maquette):
    with pytest.raises(MaquetteError, match="height") as refused:
        maquette.fit(KNOWN | {"height_m": 9}, scripted_image())
    assert refused.value.problem is not None
    assert refused.value.problem.errors[0].field == "height_m"
    with pytest.raises(MaquetteError, match="Send the whole file"):
        maquette.fit(KNOWN, scripted_image({"unusable": True}))
