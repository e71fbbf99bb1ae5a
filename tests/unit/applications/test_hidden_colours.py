"""A dressed body is photographed from the front: its back must wear the same."""

import numpy as np
import pytest

from fitter.applications.atlas import atlas_of
from fitter.applications.hidden_colours import FORGOTTEN_M, following
from fitter.applications.rings import Region, RingCoordinates
from fitter.applications.seen_surface import SurfacePoints
from fitter.applications.texture import TexelOrigin, picture_texture
from fitter.observation.colour import linear_from_display
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.render.camera import Camera
from fitter.render.interpolation import shade_image
from fitter.render.rasterizer import render
from fitter.vocabulary.choices import Gender
from tests.unit.applications.bodies import packaged

CAMERA = Camera(focal_length_px=1000.0, centre_x=300.0, centre_y=400.0, width=600, height=800)
SKIN = np.array([0.5, 0.3, 0.2])
SHIRT = np.array([0.1, 0.2, 0.6])
SHORTS = np.array([0.6, 0.1, 0.1])
HAIR = np.array([0.01, 0.01, 0.012])
WAIST_M, HEM_M, COLLAR_M = 0.1, -0.25, 0.36
BORDER_M = 0.02
"""About a hem the rings, the pixels and the vertices blur."""


class Sitter:
    """Somebody in shirt and shorts, with dark hair, in even light."""

    def __init__(self) -> None:
        self.evaluator = packaged("female").evaluator
        self.model = self.evaluator.model
        self.rings = RingCoordinates.of(self.model)
        body = BodyParameters(
            pose=self.model.canonical_pose.copy(),
            translation=np.array([0.0, -0.05, 2.9]),
            shape=np.zeros(len(self.model.shape_basis)),
        )
        self.rendering = render(self.evaluator.vertices(body), self.model.triangles, CAMERA)
        self.person = FittedPerson(
            gender=Gender.FEMALE,
            model_checksum=str(self.model.header["checksum"]),
            body=body,
            camera=CAMERA,
            light=None,
            reflectance=None,
            albedo_rgb=None,
        )
        self.picture = self.photographed(self.worn())

    def worn(self) -> np.ndarray:
        """(m, 3) what each vertex wears."""
        height = self.model.mean_vertices[:, 1]
        trunk = np.zeros(len(height), dtype=bool)
        trunk[self.model.triangles[self.rings.region == Region.TRUNK]] = True
        worn = np.tile(SKIN, (len(height), 1))
        worn[trunk & (height > HEM_M) & (height <= WAIST_M)] = SHORTS
        worn[trunk & (height > WAIST_M) & (height < COLLAR_M)] = SHIRT
        worn[self.model.triangles[self.rings.region == Region.SCALP]] = HAIR
        return worn

    def photographed(self, colours: np.ndarray) -> np.ndarray:
        channels = [shade_image(self.rendering, each, background=0.9) for each in colours.T]
        return np.stack(channels, axis=2)

    def pixel(self, landmark: str) -> tuple[int, int]:
        """Column and row of a landmark."""
        rows = self.model.landmarks
        row = rows.names.index(landmark)
        nearest = rows.indices[rows.pointers[row]]
        column, line = self.rendering.projected[nearest]
        return int(column), int(line)


@pytest.fixture(scope="module")
def sitter() -> Sitter:
    return Sitter()


def texels(sitter, texture):
    """Region, height on the mean body, linear colour and origin of all texels."""
    atlas = atlas_of(sitter.model, len(texture.levels))
    points = SurfacePoints(corners=sitter.model.triangles[atlas.triangles], weights=atlas.weights)
    return (
        sitter.rings.region[atlas.triangles],
        points.of(sitter.model.mean_vertices)[:, 1],
        texture.scale * linear_from_display(texture.levels[atlas.inside] / 255.0),
        texture.coverage[atlas.inside],
    )


@pytest.fixture(scope="module")
def dressed(sitter):
    return texels(
        sitter, picture_texture(sitter.person, sitter.evaluator, sitter.picture, size=512)
    )


@pytest.mark.parametrize(
    ("low", "high", "worn"),
    [(WAIST_M, COLLAR_M, SHIRT), (HEM_M, WAIST_M, SHORTS), (-0.7, HEM_M, SKIN)],
)
def test_clothes_go_round_the_body(dressed, low, high, worn):
    region, height, colours, origin = dressed
    behind = (
        (region == Region.TRUNK)
        & (origin == TexelOrigin.CONTINUED)
        & (height > low + BORDER_M)
        & (height < high - BORDER_M)
    )
    away = np.abs(colours[behind] - worn).max(axis=1)
    assert np.count_nonzero(behind) > 1000
    assert np.percentile(away, 95.0) < 0.05


def test_a_head_seen_from_the_front_has_hair_behind(dressed):
    region, _, colours, origin = dressed
    behind = (region == Region.SCALP) & (origin == TexelOrigin.CONTINUED)
    assert np.count_nonzero(behind) > 500
    assert np.median(np.abs(colours[behind] - HAIR).max(axis=1)) < 0.02


def test_bare_skin_stays_skin_behind(dressed):
    region, _, colours, origin = dressed
    behind = (region == Region.ARMS) & (origin == TexelOrigin.CONTINUED)
    assert np.percentile(np.abs(colours[behind] - SKIN).max(axis=1), 90.0) < 0.1


def test_hair_that_hangs_over_a_shirt_is_not_painted_on_it(sitter):
    picture = sitter.picture.copy()
    column, line = sitter.pixel("left_ear")
    _, lowest = sitter.pixel("left_nipple")
    picture[line:lowest, column - 22 : column] = HAIR
    mask = sitter.rendering.silhouette
    assert mask[lowest - 5, column - 10]
    texture = picture_texture(sitter.person, sitter.evaluator, picture, mask=mask, size=512)
    region, _, colours, _ = texels(sitter, texture)
    dark = colours[region == Region.TRUNK].max(axis=1) < 0.08
    assert dark.mean() < 0.002


def test_a_shirt_of_the_hairs_colour_is_kept(sitter):
    worn = sitter.worn()
    worn[(worn == SHIRT).all(axis=1)] = HAIR
    neck = (worn == SKIN).all(axis=1) & (sitter.model.mean_vertices[:, 1] > COLLAR_M)
    worn[neck & (sitter.model.mean_vertices[:, 0] > 0.04)] = HAIR
    mask = sitter.rendering.silhouette
    texture = picture_texture(
        sitter.person, sitter.evaluator, sitter.photographed(worn), mask=mask, size=512
    )
    region, height, colours, _ = texels(sitter, texture)
    on_shirt = (region == Region.TRUNK) & (height > WAIST_M + BORDER_M)
    on_shirt &= height < COLLAR_M - BORDER_M
    assert (np.abs(colours[on_shirt] - HAIR).max(axis=1) < 0.05).mean() > 0.9


def test_what_is_seen_at_a_border_is_forgotten_by_e_over_its_length(sitter):
    height = sitter.model.mean_vertices[:, 1]
    trunk = np.zeros(len(height), dtype=bool)
    trunk[sitter.model.triangles[sitter.rings.region == Region.TRUNK]] = True
    known = trunk & (height < -0.5)
    carried_on = following(sitter.model, known, np.where(known, 1.0, np.nan)[:, None] * np.ones(3))
    shin = trunk & (np.abs(height - (-0.5 + FORGOTTEN_M)) < 0.01)
    assert np.allclose(carried_on[known], 1.0)
    assert carried_on[shin].mean() == pytest.approx(np.exp(-1.0), abs=0.1)
