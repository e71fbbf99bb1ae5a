"""Each energy term against a closed form, and its rows against finite differences."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from scipy.spatial import KDTree

from fitter.body.model import SparseRows, regress
from fitter.body.scape import increment
from fitter.energies._picture_kernels import nearest_within
from fitter.energies.edges import EdgeCostMap, edge_energy, edge_rows
from fitter.energies.landmarks import ClickEvidence, click_energy, click_evidence, click_rows
from fitter.energies.penetration import (
    PenetrationProxy,
    penetration_energy,
    penetration_rows,
    sphere_positions,
)
from fitter.energies.rows import geman_mcclure
from fitter.energies.scales import scales_at
from fitter.energies.shading import (
    IntensityMap,
    ShadingEvidence,
    shading_energy,
    shading_rows,
    usable_vertices,
)
from fitter.energies.silhouette import silhouette_energy, silhouette_overlap, silhouette_rows
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.fits.equipment import prepared_model
from fitter.numerics.meshes import add_normal_derivative, mesh_topology
from fitter.parameters import BodyParameters, Light, Reflectance
from fitter.render.camera import Camera
from fitter.render.contours import model_edges
from fitter.render.rasterizer import render
from fitter.request import Click
from fitter.vocabulary.choices import Gender, LightKind

CAMERA = Camera(focal_length_px=300.0, centre_x=100.0, centre_y=100.0, width=200, height=200)
SCALES = scales_at(CAMERA, 3.0, boundary_eta_m=0.06)


def box(width: float, height: float, shift: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A box 3 m away, facing the camera; width and height in pixels, shifted by pixels."""
    x, y, z = np.array([width, height, 20.0]) / 100.0 / 2.0
    corners = np.array(
        [[sx * x, sy * y, sz * z] for sx in (-1, 1) for sy in (-1, 1) for sz in (-1, 1)]
    )
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = np.array(
        [t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])], dtype=np.int32
    )
    return corners + [shift / 100.0, 0.0, 3.0 + z], triangles


def rendered(width: float, height: float, shift: float = 0.0):
    vertices, triangles = box(width, height, shift)
    rendering = render(vertices, triangles, CAMERA)
    return rendering, model_edges(rendering, mesh_topology(triangles, vertex_count=8))


class TestSilhouette:
    def test_a_perfect_match_costs_nothing(self):
        rendering, _ = rendered(60, 120)
        evidence = silhouette_evidence(rendering.silhouette)
        assert silhouette_energy(rendering, evidence, SCALES) == 0.0
        assert silhouette_overlap(rendering, evidence, SCALES) == 1.0

    @pytest.mark.parametrize("shift", [2.0, 4.0])
    def test_a_shifted_outline_costs_the_robust_square_of_the_shift(self, shift):
        truth, _ = rendered(60, 120)
        evidence = silhouette_evidence(truth.silhouette)
        moved, _ = rendered(60, 120, shift)
        robust = 0.5 * shift**2 / (1 + (shift / SCALES.silhouette_eta) ** 2)
        expected = 2 * 120 * robust / (SCALES.silhouette_sigma**2 * SCALES.correlation_length)
        assert silhouette_energy(moved, evidence, SCALES) == pytest.approx(expected, rel=0.25)

    def test_wrong_ground_far_from_the_body_costs_little_more(self):
        rendering, _ = rendered(60, 80)
        mask = rendering.silhouette.copy()
        near = mask.copy()
        near[140:146, 70:130] = True
        far = mask.copy()
        far[140:190, 70:130] = True
        cost_near = silhouette_energy(rendering, silhouette_evidence(near), SCALES)
        cost_far = silhouette_energy(rendering, silhouette_evidence(far), SCALES)
        assert cost_near > 0.0
        # Eight times the area; a truncated square would grow at least as much.
        assert cost_far < 6.0 * cost_near

    def test_rows_pull_a_shifted_body_back(self):
        truth, _ = rendered(60, 120)
        evidence = silhouette_evidence(truth.silhouette)
        moved, edges = rendered(60, 120, 3.0)
        for rows in silhouette_rows(moved, edges, evidence, SCALES):
            push = (rows.weights * rows.residuals)[:, None, None] * rows.derivatives
            assert push[..., 0].sum() > 0.0
            assert abs(push[..., 1].sum()) < 0.1 * push[..., 0].sum()

    def test_an_empty_rendering_is_a_cost_and_no_error(self):
        truth, _ = rendered(60, 120)
        away, edges = rendered(60, 120, 5000.0)
        evidence = silhouette_evidence(truth.silhouette)
        assert silhouette_energy(away, evidence, SCALES) > 0.0
        assert silhouette_overlap(away, evidence, SCALES) == 0.0
        assert all(len(r.residuals) == 0 for r in silhouette_rows(away, edges, evidence, SCALES))

    def test_the_energy_is_that_of_whole_distance_maps(self):
        """Against the plain sum with an exact distance to the model at every pixel."""
        truth, _ = rendered(60, 120)
        mask = truth.silhouette.copy()
        mask[:, 150:190] = True
        mask[5:60, 80:90] = True
        evidence = silhouette_evidence(mask)
        moved, _ = rendered(50, 110, 4.0)
        model = moved.silhouette
        to_model = cv2.distanceTransform(
            (~model).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE
        )
        distance = np.where(model, evidence.signed_distance, to_model)[model != mask]
        eta = SCALES.silhouette_eta
        cost = distance / (1.0 + (distance / eta) ** 2) ** 2
        cost = np.where(distance > eta, np.maximum(cost, 0.1 * eta), cost)
        expected = cost.sum() / (SCALES.silhouette_sigma**2 * SCALES.correlation_length)
        assert silhouette_energy(moved, evidence, SCALES) == pytest.approx(expected, rel=1e-4)

    def test_outline_points_are_matched_as_a_tree_of_position_and_normal_matches_them(self):
        rng = np.random.default_rng(3)
        keys, queries = 40.0 * rng.random((300, 4)), 40.0 * rng.random((200, 4))
        keys = keys[np.argsort(keys[:, 0])]
        distance, nearest = KDTree(keys).query(queries, distance_upper_bound=5.0)
        expected = np.where(np.isfinite(distance), nearest, -1)
        assert 0 < np.count_nonzero(expected < 0) < len(queries)
        np.testing.assert_array_equal(nearest_within(keys, queries, 5.0), expected)


class TestEdges:
    def test_the_energy_is_the_mean_cost_along_visible_edges(self):
        _, edges = rendered(60, 120)
        constant = EdgeCostMap(cost=np.full((200, 200), 0.3, dtype=np.float32))
        assert edge_energy(edges, constant, SCALES) == pytest.approx(0.3 * SCALES.edge_weight)

    def test_rows_are_the_slope_of_the_energy(self):
        ramp = np.tile(np.linspace(0.1, 0.9, 200, dtype=np.float32), (200, 1))
        cost = EdgeCostMap(cost=ramp)
        rendering, edges = rendered(60, 120)
        rows = edge_rows(rendering, edges, cost, SCALES)
        slope = ((rows.weights * rows.residuals)[:, None, None] * rows.derivatives)[..., 0].sum()
        step = 0.5
        plus = edge_energy(rendered(60, 120, step)[1], cost, SCALES)
        minus = edge_energy(rendered(60, 120, -step)[1], cost, SCALES)
        assert slope == pytest.approx((plus - minus) / (2 * step / 100.0), rel=0.02)


class TestClicks:
    ROWS = SparseRows(
        names=("nose", "head_top"),
        pointers=np.array([0, 1, 2]),
        indices=np.array([0, 1]),
        weights=np.ones(2),
    )

    def test_rows_are_the_slope_of_the_energy(self):
        evidence = click_evidence(
            self.ROWS, {"head_top": Click(x=103, y=98), "nose": Click(x=90, y=120)}
        )
        points = np.array([[0.02, -0.01, 3.0], [0.05, 0.2, 2.8]])
        rows = click_rows(points, evidence, CAMERA, SCALES)
        slope = np.zeros_like(points)
        np.add.at(
            slope,
            rows.points[:, 0],
            (rows.weights * rows.residuals)[:, None] * rows.derivatives[:, 0],
        )
        for index in np.ndindex(points.shape):
            delta = np.zeros_like(points)
            delta[index] = 1e-6
            plus = click_energy(points + delta, evidence, CAMERA, SCALES)
            minus = click_energy(points - delta, evidence, CAMERA, SCALES)
            assert slope[index] == pytest.approx((plus - minus) / 2e-6, rel=1e-4, abs=1e-6)

    def test_clicks_are_paired_with_landmarks_by_name(self):
        evidence = click_evidence(self.ROWS, {"head_top": Click(x=1, y=2)})
        vertices = np.array([[1.0, 0, 0], [2.0, 0, 0]])
        np.testing.assert_array_equal(regress(evidence.landmarks, vertices), [[2.0, 0, 0]])

    def test_a_hidden_point_counts_less(self):
        seen = click_evidence(self.ROWS, {"nose": Click(x=1, y=2)})
        hidden = click_evidence(self.ROWS, {"nose": Click(x=1, y=2, occluded=True)})
        point = np.array([[0.0, 0.0, 3.0]])
        assert click_energy(point, hidden, CAMERA, SCALES) < 0.2 * click_energy(
            point, seen, CAMERA, SCALES
        )

    def test_a_wild_click_pulls_no_harder_than_the_truncation(self):
        rows = self.ROWS
        pulls = []
        for x in (150.0, 1500.0):
            evidence = ClickEvidence(
                landmarks=rows,
                clicks=np.array([[x, 100.0]]),
                confidence=np.ones(1),
                spread_m=np.full(1, 0.02),
            )
            found = click_rows(np.array([[0.0, 0.0, 3.0]]), evidence, CAMERA, SCALES)
            pulls.append(abs(found.weights[0] * found.residuals[0]))
        assert pulls[1] == pytest.approx(pulls[0], rel=1e-6)


class TestPenetration:
    PROXY = PenetrationProxy(
        centres=SparseRows(
            names=("a", "b"),
            pointers=np.array([0, 2, 4]),
            indices=np.arange(4),
            weights=np.full(4, 0.5),
        ),
        fillings=np.full(2, 0.9),
        pairs=np.array([[0, 1]]),
    )

    def vertices(self, gap: float) -> np.ndarray:
        """Two rings of radius 0.1 whose centres are ``gap`` apart."""
        ring = np.array([[0, 0.1, 0], [0, -0.1, 0]])
        return np.concatenate([ring, ring + [gap, 0, 0]])

    def test_the_energy_is_half_the_squared_overlap_over_its_spread(self):
        centres, radii = sphere_positions(self.PROXY, self.vertices(0.15))
        overlap = radii.sum() - 0.15
        assert overlap > 0
        assert penetration_energy(centres, radii, self.PROXY, SCALES) == pytest.approx(
            0.5 * (overlap / SCALES.penetration_sigma_m) ** 2
        )

    def test_parts_that_do_not_touch_cost_nothing_and_give_no_rows(self):
        centres, radii = sphere_positions(self.PROXY, self.vertices(0.3))
        assert penetration_energy(centres, radii, self.PROXY, SCALES) == 0.0
        assert len(penetration_rows(centres, radii, self.PROXY, SCALES).residuals) == 0

    def test_rows_are_the_slope_of_the_energy(self):
        centres, radii = sphere_positions(self.PROXY, self.vertices(0.15))
        rows = penetration_rows(centres, radii, self.PROXY, SCALES)
        slope = rows.weights[0] * rows.residuals[0] * rows.derivatives[0]
        for index in np.ndindex(centres.shape):
            delta = np.zeros_like(centres)
            delta[index] = 1e-7
            plus = penetration_energy(centres + delta, radii, self.PROXY, SCALES)
            minus = penetration_energy(centres - delta, radii, self.PROXY, SCALES)
            assert slope[index] == pytest.approx((plus - minus) / 2e-7, rel=1e-4, abs=1e-3)

    def test_an_arm_pushed_into_the_trunk_is_penalised(self):
        operators = prepared_model(Gender.FEMALE).operators
        model = operators.model
        body = BodyParameters(
            pose=model.canonical_pose,
            translation=np.zeros(3),
            shape=np.zeros(len(model.shape_basis)),
        )
        turn = np.zeros_like(body.pose)
        turn[model.part_names.index("left_upper_arm")] = [0.0, 0.0, -1.2]
        pushed = increment(body, pose=turn, translation=np.zeros(3), shape=0.0 * body.shape)

        def energy(parameters: BodyParameters) -> float:
            vertices = operators.evaluator.vertices(parameters)
            spheres, radii = sphere_positions(operators.penetration, vertices)
            return penetration_energy(spheres, radii, operators.penetration, SCALES)

        assert energy(body) == 0.0
        assert energy(pushed) > 10.0


@pytest.fixture(scope="module")
def lit():
    """A packaged body whose picture is a plane of intensity, so that slopes are exact."""
    operators = prepared_model(Gender.MALE).operators
    model = operators.model
    camera = Camera(focal_length_px=300.0, centre_x=100.0, centre_y=150.0, width=200, height=300)
    body = BodyParameters(
        pose=model.canonical_pose,
        translation=np.array([0.0, 0.0, 2.8]),
        shape=np.zeros(len(model.shape_basis)),
    )
    rendering = render(operators.evaluator.vertices(body), model.triangles, camera)
    y, x = np.mgrid[:300, :200]
    evidence = ShadingEvidence(
        intensity=IntensityMap(
            luminance=(0.2 + 0.001 * x + 0.0005 * y).astype(np.float32),
            trusted=np.ones((300, 200), dtype=bool),
        ),
        light=Light(kind=LightKind.POINT, azimuth=0.4, elevation=0.3, distance=2.0),
        body_centre=body.translation,
        reflectance=Reflectance(
            albedo=np.full(len(rendering.vertices), 0.4),
            specularity=np.full(len(rendering.vertices), 0.1),
            ambient=0.05,
            specular_exponent=10.0,
        ),
        vertex_areas=operators.shaded.areas,
        shadowed=np.zeros(len(rendering.vertices), dtype=bool),
        eta=0.1,
    )
    return operators, rendering, evidence


class TestShading:
    def test_shading_costs_most_where_nothing_is_explained(self, lit):
        _, rendering, evidence = lit
        most = SCALES.shading_weight * np.log(1.0 + 1.0 / SCALES.shading_floor)
        assert 0.0 < shading_energy(rendering, evidence, SCALES) < most
        dark = replace(evidence.reflectance, albedo=50.0 * evidence.reflectance.albedo)
        hopeless = shading_energy(rendering, replace(evidence, reflectance=dark), SCALES)
        assert hopeless == pytest.approx(most, rel=0.05)
        hidden = replace(evidence, shadowed=np.ones_like(evidence.shadowed))
        assert shading_energy(rendering, hidden, SCALES) == pytest.approx(most)

    def test_what_is_explained_counts_less_where_more_stays_unexplained(self, lit):
        _, rendering, evidence = lit
        upper = rendering.vertices[:, 1] < np.median(rendering.vertices[:, 1])
        albedo = np.where(upper, 50.0, 1.0) * evidence.reflectance.albedo
        half = replace(evidence, reflectance=replace(evidence.reflectance, albedo=albedo))
        whole, clothed = (shading_rows(rendering, each, SCALES) for each in (evidence, half))
        skin = ~upper[whole.vertices]
        unexplained = (
            np.average(geman_mcclure(each.residuals, evidence.eta), weights=areas)
            for each in (whole, clothed)
            for areas in [evidence.vertex_areas[each.vertices]]
        )
        floor = SCALES.shading_floor
        less, more = (floor + each for each in unexplained)
        assert more > 1.2 * less
        np.testing.assert_allclose(
            clothed.weights[skin], less / more * whole.weights[skin], rtol=1e-12
        )

    def test_rows_are_the_slope_of_the_energy(self, lit):
        operators, rendering, evidence = lit
        triangles = operators.model.triangles
        direction = rendering.vertex_normals * (1 + rendering.vertices[:, 1:2])
        step = 2e-6
        behind, ahead = (
            render(rendering.vertices + sign * step * direction, triangles, rendering.camera)
            for sign in (-1, 1)
        )
        # Which vertices count must not change on the way.
        steady = np.logical_and.reduce(
            [usable_vertices(each, evidence) for each in (behind, rendering, ahead)]
        )
        evidence = replace(evidence, shadowed=~steady)
        rows = shading_rows(rendering, evidence, SCALES)
        force = (rows.weights * rows.residuals)[:, None]
        pull = np.zeros_like(rendering.vertices)
        pull[rows.vertices] = force * rows.position_derivatives
        add_normal_derivative(
            rendering.vertices,
            triangles,
            operators.rings,
            rows.vertices,
            force * rows.normal_derivatives,
            pull,
        )
        gained = shading_energy(ahead, evidence, SCALES) - shading_energy(behind, evidence, SCALES)
        assert (pull * direction).sum() == pytest.approx(gained / (2 * step), rel=0.02)

    def test_rows_know_how_the_light_moves_with_the_body(self, lit):
        _, rendering, evidence = lit
        rows = shading_rows(rendering, evidence, SCALES)
        slope = rows.centre_derivatives.T @ (rows.weights * rows.residuals)
        for axis, direction in enumerate(1e-5 * np.eye(3)):
            ahead, behind = (
                shading_energy(rendering, evidence.about(evidence.body_centre + each), SCALES)
                for each in (direction, -direction)
            )
            assert slope[axis] == pytest.approx((ahead - behind) / 2e-5, rel=1e-3)
