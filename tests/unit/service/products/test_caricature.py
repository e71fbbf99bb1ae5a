"""What is unusual of the body, exaggerated."""

import pytest

from service.compute.tasks import UnusableInputError
from tests.unit.export.glb_reader import read_glb
from tests.unit.service.products.samples import made


def test_a_caricature_says_what_was_exaggerated():
    output = made(kind="caricature", factor=1.5)
    result = output.result.model_dump()
    assert (result["coefficient"], result["before"], result["after"]) == (2, 1.0, 1.5)
    glb = read_glb(output.files["body_caricature.glb"])
    positions = glb.attribute("POSITION")
    assert positions[:, 1].min() == pytest.approx(0.0, abs=1e-6)
    assert glb.document["asset"]["extras"]["factor"] == 1.5


def test_a_caricature_of_looks_exaggerates_every_coefficient():
    fitted = made(kind="caricature", exaggerated="looks", factor=1.0).result.model_dump()
    looks = made(kind="caricature", exaggerated="looks", factor=1.5)
    result = looks.result.model_dump()
    assert result["shape"][1:] == pytest.approx([1.5 * value for value in fitted["shape"][1:]])
    extras = read_glb(looks.files["body_caricature.glb"]).document["asset"]["extras"]
    assert extras["exaggerated"] == "looks"


def test_a_factor_that_turns_the_surface_inside_out_is_refused_with_the_largest():
    with pytest.raises(UnusableInputError) as caught:
        made(kind="caricature", factor=99.0)
    assert caught.value.error.field == "factor"
    assert caught.value.error.largest < 99.0
