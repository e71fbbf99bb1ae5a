"""What clients are told of pictures before they send them is what the fit holds them to."""

from api_schemas.picture import LARGEST_ASPECT_RATIO, LEAST_SIDE_PX
from fitter.observation import decoding


def test_clients_and_the_decoder_have_the_same_limits():
    assert LEAST_SIDE_PX == decoding.LEAST_SIDE_PX
    assert LARGEST_ASPECT_RATIO == decoding.LARGEST_ASPECT_RATIO
