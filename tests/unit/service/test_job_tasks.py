"""A child reads what was stored of a fit, or of what is derived from one."""

import json

from service.compute.tasks import OPTIONS, fit_input, product_input
from service.jobs.inputs import SentPicture, named_pictures, pictures_of
from service.numerics.tasks import ChildSetup

SETUP = ChildSetup(
    name="job",
    tasks="p",
    max_pixels=9,
    models=None,
    detector=None,
    memory_mb=1,
    log_level="INFO",
    log_format="text",
)
FRONT, SIDE = SentPicture(b"f", None), SentPicture(b"s", b"m")


def test_pictures_come_in_the_order_of_the_views():
    asked = {"gender": "male", "views": [{"view": "front"}, {"view": "side"}]}
    files = named_pictures([FRONT, SIDE])
    parts = {OPTIONS: json.dumps(asked).encode(), **dict(reversed(files.items()))}
    job = fit_input(SETUP, parts)
    assert job.pictures == (FRONT, SIDE)
    assert [each.view for each in job.request.views] == ["front", "side"]


def test_names_of_pictures_say_of_which_view_they_are():
    assert named_pictures([FRONT, SIDE]) == {
        "views/0/image": b"f",
        "views/1/image": b"s",
        "views/1/mask": b"m",
    }
    for pictures in ([SIDE], [FRONT, SIDE], [FRONT] * 6):
        assert pictures_of(named_pictures(pictures)) == tuple(pictures)


def test_what_a_fit_left_reaches_the_pipeline():
    asked = json.dumps({"kind": "caricature", "factor": 2.0}).encode()
    product = product_input(SETUP, {OPTIONS: asked, "person.npz": b"p"})
    assert dict(product.files) == {"person.npz": b"p"}
