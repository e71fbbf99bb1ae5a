"""A dressed body is photographed from the front: its back must wear the same."""

import cv2
import numpy as np
import pytest

from fitter.applications.atlas import atlas_of
from fitter.applications.picture_surface import SurfacePoints
from fitter.applications.rings import Region, RingCoordinates
from fitter.applications.texture import TexelOrigin, picture_texture
from fitter.body.model import regress
from fitter.numerics.rotations import rotation_matrices, rotation_vectors
from fitter.observation.pixels import linear_from_display
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.render.camera import Camera
from fitter.render.rasterizer import render, shade_image
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

    def __init__(self, *, turned: float = 0.0) -> None:
        self.evaluator = packaged("female").evaluator
        self.model = self.evaluator.model
        self.rings = RingCoordinates.of(self.model)
        body = BodyParameters(
            pose=turned_about_vertical(self.model.canonical_pose, turned),
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


def turned_about_vertical(pose: np.ndarray, angle: float) -> np.ndarray:
    turn = rotation_matrices(np.array([[0.0, angle, 0.0]]))
    whole = rotation_vectors(turn @ rotation_matrices(pose[:1]))
    return np.concatenate([whole, pose[1:]])


@pytest.fixture(scope="module")
def sitter() -> Sitter:
    return Sitter()


def points_of(sitter):
    atlas = atlas_of(sitter.model, 512)
    return SurfacePoints(corners=sitter.model.triangles[atlas.triangles], weights=atlas.weights)


def texels(sitter, texture):
    """Region, height on the mean body, linear colour and origin of all texels."""
    points, inside = points_of(sitter), atlas_of(sitter.model, 512).inside
    return (
        points.of(sitter.rings.shares.T).argmax(axis=1),
        points.of(sitter.model.mean_vertices)[:, 1],
        texture.scale * linear_from_display(texture.levels[inside] / 255.0),
        texture.coverage[inside],
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


def test_a_hat_above_a_high_forehead_goes_all_round(sitter):
    worn, outside = sitter.worn(), ~sitter.rendering.silhouette
    worn[(worn == HAIR).all(axis=1)] = SKIN
    picture, mask = sitter.photographed(worn), ~outside
    column, line = sitter.pixel("head_top")
    hat = np.s_[line - 18 : line + 25, column - 40 : column + 40]
    mask[hat], picture[hat] = True, np.where(outside[hat][..., None], SHORTS, picture[hat])
    texture = picture_texture(sitter.person, sitter.evaluator, picture, mask=mask, size=512)
    region, _, colours, origin = texels(sitter, texture)
    behind = (region == Region.SCALP) & (origin == TexelOrigin.CONTINUED)
    assert np.median(np.abs(colours[behind] - SHORTS).max(axis=1)) < 0.02


def test_hair_that_hangs_over_a_shirt_is_not_painted_on_it(sitter):
    picture = sitter.picture.copy()
    column, line = sitter.pixel("left_ear")
    _, lowest = sitter.pixel("left_nipple")
    picture[line:lowest, column - 22 : column] = HAIR
    mask = sitter.rendering.silhouette
    assert mask[lowest - 5, column - 10]
    texture = picture_texture(sitter.person, sitter.evaluator, picture, mask=mask, size=512)
    region, _, colours, _ = texels(sitter, texture)
    assert (colours[region == Region.TRUNK].max(axis=1) < 0.08).mean() < 0.002


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


def test_no_texel_has_a_colour_from_beyond_the_mask(sitter):
    """Whose mask is narrower than the body: beside it everything is green."""
    shown = sitter.rendering.silhouette.astype(np.uint8)
    mask = cv2.erode(shown, np.ones((9, 9), np.uint8)) > 0
    picture = np.where(mask[..., None], sitter.picture, [0.0, 0.9, 0.0])
    texture = picture_texture(sitter.person, sitter.evaluator, picture, mask=mask, size=512)
    _, _, colours, _ = texels(sitter, texture)
    # Nothing worn is green, nor is any mixture of it.
    assert (colours[:, 1] - np.maximum(colours[:, 0], colours[:, 2])).max() < 0.01


def test_a_pattern_is_not_drawn_out_to_stripes_behind(sitter):
    worn, height = sitter.worn(), sitter.model.mean_vertices[:, 1]
    shirt = (worn == SHIRT).all(axis=1)
    worn[shirt & (height % 0.06 < 0.03)] = [0.2, 0.35, 0.6]
    texture = picture_texture(sitter.person, sitter.evaluator, sitter.photographed(worn), size=512)
    region, height, colours, origin = texels(sitter, texture)
    shirt = (region == Region.TRUNK) & (height > WAIST_M + BORDER_M)
    shirt &= height < COLLAR_M - 0.1
    spread = {
        each: colours[shirt & (origin == each)].std(axis=0).max()
        for each in (TexelOrigin.SEEN, TexelOrigin.CONTINUED)
    }
    assert spread[TexelOrigin.CONTINUED] < 0.4 * spread[TexelOrigin.SEEN]


def test_a_swimsuit_has_no_hole_between_the_legs(sitter):
    model, worn = sitter.model, sitter.worn()
    crotch = regress(model.landmarks, model.mean_vertices)[model.landmarks.names.index("crotch"), 1]
    aside, height = np.abs(model.mean_vertices[:, 0]), model.mean_vertices[:, 1]
    worn[(worn == SHORTS).all(axis=1) & (height < crotch + aside - 0.04)] = SKIN
    texture = picture_texture(sitter.person, sitter.evaluator, sitter.photographed(worn), size=512)
    region, height, colours, _ = texels(sitter, texture)
    aside = np.abs(points_of(sitter).of(model.mean_vertices)[:, 0])
    level = (region == Region.TRUNK) & (np.abs(height - crotch) < 0.02)
    assert np.median(np.abs(colours[level & (aside < 0.02)] - SHORTS).max(axis=1)) < 0.1
    assert np.median(np.abs(colours[level & (aside > 0.1)] - SKIN).max(axis=1)) < 0.05


def near_eyes(model, places, *, within_m=0.018):
    rows = model.landmarks
    near = np.zeros(len(places), dtype=bool)
    for side in ("left", "right"):
        row = rows.names.index(f"{side}_eye")
        eye = model.mean_vertices[rows.indices[rows.pointers[row]]]
        near |= np.linalg.norm(places - eye, axis=1) < within_m
    return near


@pytest.mark.parametrize(("turned", "is_shown"), [(0.0, True), (0.5, True), (1.4, False)])
def test_a_face_is_shown_whole_or_as_plain_skin(turned, is_shown):
    sitter = Sitter(turned=turned)
    worn = sitter.worn()
    eyes = near_eyes(sitter.model, sitter.model.mean_vertices)
    worn[eyes] = painted = [0.1, 0.6, 0.1]
    texture = picture_texture(sitter.person, sitter.evaluator, sitter.photographed(worn), size=512)
    points = points_of(sitter)
    eyes = near_eyes(sitter.model, points.of(sitter.model.mean_vertices), within_m=0.01)
    _, _, colours, _ = texels(sitter, texture)
    green = np.abs(colours[eyes] - painted).max(axis=1) < 0.1
    assert green.mean() > 0.5 if is_shown else green.mean() < 0.01


def test_a_checked_shirt_without_a_thread_of_its_median_colour_goes_round(sitter):
    worn = sitter.worn()
    shirt = np.flatnonzero((worn == SHIRT).all(axis=1))
    lines = (100.0 * sitter.model.mean_vertices[shirt, :2]).astype(int).sum(axis=1) % 3
    worn[shirt] = np.array([[0.6, 0.05, 0.05], [0.05, 0.4, 0.1], [0.8, 0.75, 0.6]])[lines]
    picture = sitter.photographed(worn)
    assert picture_texture(sitter.person, sitter.evaluator, picture, size=128).seen_share > 0.1
