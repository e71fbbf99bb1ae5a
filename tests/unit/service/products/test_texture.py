"""The picture or its albedo on the body."""

import pytest

from api_schemas.products.bodies import TEXTURE_SIZES
from fitter.applications.texture import SIZES
from service.compute.tasks import UnusableInputError
from tests.unit.service.products.samples import made


def test_a_texture_with_its_light_divided_out_needs_a_fit_with_shading():
    with pytest.raises(UnusableInputError) as caught:
        made(kind="texture", colours="albedo")
    assert caught.value.error.field == "colours"


def test_the_sizes_of_textures_on_the_wire_are_the_fitter_s():
    assert TEXTURE_SIZES == SIZES
