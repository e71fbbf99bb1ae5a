"""What is painted on the atlas lies on the body where it was painted, and nowhere else."""

import numpy as np
import pytest

from fitter.applications.atlas import triangles_of_texels
from fitter.applications.own_texture import (
    LEAST_SIDE,
    LINE,
    TINT_OPACITY,
    atlas_drawing,
    painted_texture,
)
from fitter.applications.texture import SIZES
from fitter.body.model import BodyModel
from fitter.errors import InvalidInputError
from tests.unit.applications.bodies import packaged

SIZE = 256


@pytest.fixture(scope="module")
def model() -> BodyModel:
    return packaged("female").evaluator.model


@pytest.fixture(scope="module")
def parts(model) -> np.ndarray:
    """The part of each texel, -1 off the body."""
    return np.append(model.part_of_triangle, -1)[triangles_of_texels(model, SIZE)]


@pytest.fixture(scope="module")
def drawing(model) -> np.ndarray:
    return atlas_drawing(model, SIZE)


def test_what_is_painted_on_the_body_stays_and_what_is_beside_it_does_not_count(model, parts):
    painted = np.random.default_rng(1).integers(0, 200, (SIZE, SIZE, 3), dtype=np.uint8)
    spoilt = np.where((parts >= 0)[..., None], painted, 255).astype(np.uint8)
    levels = painted_texture(spoilt, model, field="texture")
    np.testing.assert_array_equal(levels[parts >= 0], painted[parts >= 0])
    assert levels.max() < 200
    np.testing.assert_array_equal(levels, painted_texture(painted, model, field="texture"))


def test_islands_go_on_into_their_margins(model, parts):
    levels = painted_texture(np.full((SIZE, SIZE, 3), 90, np.uint8), model, field="texture")
    beside = np.roll(parts >= 0, 1, axis=0) & (parts < 0)
    assert beside.any()
    assert (levels[beside] == 90).all()


@pytest.mark.parametrize("size", [(200, 300), (LEAST_SIDE - 1,) * 2, (SIZES[-1] + 1,) * 2])
def test_a_texture_of_a_size_that_no_atlas_has_is_refused_with_the_field(model, size):
    with pytest.raises(InvalidInputError, match="texels") as caught:
        painted_texture(np.zeros((*size, 3), np.uint8), model, field="texture")
    assert caught.value.field == "texture"


def test_the_drawing_is_nothing_off_the_body_but_for_names(drawing, parts):
    off = drawing[parts < 0]
    assert (off[:, 3] == 0).mean() > 0.99


def test_every_part_has_a_tint_of_its_own_through_which_one_sees(model, drawing, parts):
    tints = set()
    for part in range(len(model.part_names)):
        texels = drawing[parts == part]
        shown = texels[texels[:, 3] == TINT_OPACITY]
        # Hands and feet of a small atlas are largely outline.
        assert len(shown) > 0.2 * len(texels), model.part_names[part]
        colours = np.unique(shown[:, :3], axis=0)
        assert len(colours) == 1
        tints.add(tuple(colours[0]))
    assert len(tints) == len(model.part_names)


def test_outlines_lie_between_parts_and_along_the_edges(drawing, parts):
    across = parts[:, 1:] != parts[:, :-1]
    for texels, those in ((drawing[:, 1:], parts[:, 1:]), (drawing[:, :-1], parts[:, :-1])):
        drawn = texels[across & (those >= 0)]
        np.testing.assert_array_equal(drawn, np.broadcast_to(LINE, drawn.shape))


def test_every_part_bears_its_name(model, monkeypatch):
    """What is written, and that the middle of it lies on the part it names."""
    written: list[tuple[str, int, int]] = []
    monkeypatch.setattr(
        "fitter.applications.own_texture._write",
        lambda drawing, text, row, column: written.append((text, row, column)),
    )
    atlas_drawing(model, 1024)
    parts = np.append(model.part_of_triangle, -1)[triangles_of_texels(model, 1024)]
    assert {text for text, _, _ in written} == {name.replace("_", " ") for name in model.part_names}
    for text, row, column in written:
        assert model.part_names[parts[row, column]] == text.replace(" ", "_")


def test_the_same_drawing_has_the_same_texels(model, drawing):
    np.testing.assert_array_equal(drawing, atlas_drawing(model, SIZE))
