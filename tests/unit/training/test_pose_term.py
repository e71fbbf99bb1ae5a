import numpy as np
import trimesh

from fitter.body.model import BodyModel, SparseRows
from fitter.body.scape import ScapeEvaluator, pose_features
from fitter.numerics.meshes import gradient_operator, part_laplacians, triangle_areas
from fitter.parameters import BodyParameters
from fitter.training.articulation.parts import (
    PART_NAMES,
    PART_PARENT,
    Parts,
    cut_into_parts,
    part_index,
)
from fitter.training.articulation.pose_term import (
    BilinearSums,
    PoseExample,
    PoseTerm,
    pose_feature_joints,
    solve_bilinear,
    train_pose_term,
)
from tests.unit.body.synthetic_model import undecimated

FEATURES, SHAPES, OUTPUTS = 4, 3, 6
ALIKE = np.eye(OUTPUTS // 3)


def examples(count: int, strengths: np.ndarray, linear: np.ndarray):
    draws = np.random.default_rng(112)
    for _ in range(count):
        x, shape = draws.normal(size=FEATURES), draws.normal(size=SHAPES)
        yield x, shape, ((1.0 + strengths @ shape) * x) @ linear


def solved(count: int, strengths: np.ndarray, linear: np.ndarray, ridge: float = 1e-12):
    sums = BilinearSums(feature_count=FEATURES, shape_count=SHAPES, output_count=OUTPUTS)
    for x, shape, output in examples(count, strengths, linear):
        sums.add(x, shape, output)
    return solve_bilinear(sums, ridge, ALIKE)


def test_a_planted_bilinear_law_is_recovered():
    draws = np.random.default_rng(13)
    strengths = 0.2 * draws.normal(size=(FEATURES, SHAPES))
    linear = draws.normal(size=(FEATURES, OUTPUTS))
    found = solved(500, strengths, linear)
    np.testing.assert_allclose(found.linear, linear, rtol=0.02, atol=0.01)
    np.testing.assert_allclose(found.strengths, strengths, rtol=0.05, atol=0.01)


def test_a_linear_law_needs_no_strengths():
    draws = np.random.default_rng(13)
    linear = draws.normal(size=(FEATURES, OUTPUTS))
    found = solved(200, np.zeros((FEATURES, SHAPES)), linear)
    np.testing.assert_allclose(found.linear, linear, atol=1e-8)
    np.testing.assert_allclose(found.strengths, 0.0, atol=1e-8)


def test_a_feature_that_never_occurs_learns_nothing():
    draws = np.random.default_rng(13)
    sums = BilinearSums(feature_count=2, shape_count=1, output_count=3)
    for _ in range(50):
        sums.add(np.array([draws.normal(), 0.0]), draws.normal(size=1), draws.normal(size=3))
    np.testing.assert_array_equal(solve_bilinear(sums, 1e-3, np.eye(1)).linear[1], 0.0)


def test_no_examples_give_no_term():
    sums = BilinearSums(feature_count=2, shape_count=1, output_count=3)
    found = solve_bilinear(sums, 1e-3, np.eye(1))
    assert not found.linear.any()
    assert not found.strengths.any()


def test_a_stronger_ridge_gives_a_smaller_answer():
    draws = np.random.default_rng(13)
    linear = draws.normal(size=(FEATURES, OUTPUTS))
    weak, strong = (
        np.linalg.norm(solved(100, np.zeros((FEATURES, SHAPES)), linear, ridge).linear)
        for ridge in (1e-6, 10.0)
    )
    assert strong < 0.5 * weak


FOOT, SHIN = part_index("left_foot"), part_index("left_shin")
SPHERE = trimesh.creation.icosphere(subdivisions=4)
TRIANGLES = np.asarray(SPHERE.faces)
REST = np.asarray(SPHERE.vertices)
JOINTS = pose_feature_joints()
FIRST = 9 * list(JOINTS[SHIN]).index(FOOT)
OF_FOOT = slice(FIRST, FIRST + 9)


def slices_of_a_sphere() -> Parts:
    """Seventeen slices from bottom to top, so that the left foot touches only its neighbours."""
    order = np.argsort(REST[:, 2])
    weights = np.zeros((len(REST), len(PART_NAMES)))
    sequence = [FOOT, SHIN, *(p for p in range(len(PART_NAMES)) if p not in (FOOT, SHIN))]
    for part, vertices in zip(sequence, np.array_split(order, len(PART_NAMES)), strict=True):
        weights[vertices, part] = 1.0
    return cut_into_parts(TRIANGLES, weights)


def laplacians_of(parts: Parts):
    return part_laplacians(
        gradient_operator(REST, TRIANGLES),
        triangle_areas(REST, TRIANGLES),
        parts.part_of_triangle,
        len(PART_NAMES),
    )


def planted_examples(parts: Parts, count: int, strength: np.ndarray):
    """Turning the foot moves the shin by (1 + s . β) D (R_foot - I), and nothing else."""
    rng = np.random.default_rng(7)
    planted = rng.normal(scale=0.05, size=(*REST.shape, 9))
    for part in set(range(len(PART_NAMES))) - {SHIN}:
        start, stop = parts.incidence_pointers[part : part + 2]
        planted[parts.incidence_vertices[start:stop]] = 0.0
    examples = []
    for _ in range(count):
        pose = np.zeros((len(PART_NAMES), 3))
        pose[FOOT] = rng.normal(size=3)
        shape = rng.normal(size=2)
        phi = (1.0 + strength @ shape) * pose_features(pose, JOINTS)[SHIN, OF_FOOT]
        posed = REST + planted @ phi
        examples.append(PoseExample(rest=REST, posed=posed, pose=pose, shape=shape))
    return planted, examples


def test_regression_recovers_a_planted_linear_term():
    parts = slices_of_a_sphere()
    laplacians = laplacians_of(parts)
    planted, examples = planted_examples(parts, 40, np.zeros(2))
    term = train_pose_term(examples, laplacians, parts, JOINTS, 2, ridge=1e-13)
    start, stop = parts.incidence_pointers[SHIN : SHIN + 2]
    vertices = parts.incidence_vertices[start:stop]
    expected = np.tensordot(laplacians[SHIN].toarray(), planted, axes=1)[vertices]
    found = term.right_hand_sides[start:stop, :, OF_FOOT]
    np.testing.assert_allclose(found, expected, atol=1e-6)
    np.testing.assert_allclose(term.strengths, 0.0, atol=1e-6)


def test_regression_recovers_how_the_term_grows_with_the_body():
    parts = slices_of_a_sphere()
    strength = np.array([0.2, -0.1])
    _, examples = planted_examples(parts, 100, strength)
    term = train_pose_term(examples, laplacians_of(parts), parts, JOINTS, 2, ridge=1e-13)
    expected = np.broadcast_to(strength, (9, 2))
    np.testing.assert_allclose(term.strengths[SHIN, OF_FOOT], expected, rtol=0.1)


def test_the_trained_term_reproduces_its_examples_at_run_time():
    parts = slices_of_a_sphere()
    _, examples = planted_examples(parts, 40, np.zeros(2))
    term = train_pose_term(examples, laplacians_of(parts), parts, JOINTS, 2, ridge=1e-13)
    evaluator = ScapeEvaluator(sphere_model(parts, term))
    for example in examples[:5]:
        parameters = BodyParameters(pose=example.pose, translation=np.zeros(3), shape=example.shape)
        found = evaluator.body_frame_vertices(parameters)
        np.testing.assert_allclose(
            found - found.mean(axis=0), example.posed - example.posed.mean(axis=0), atol=2e-5
        )


def test_a_body_at_rest_has_no_features():
    assert not pose_features(np.zeros((len(PART_NAMES), 3)), JOINTS).any()


def test_limbs_feel_the_joints_of_their_own_side():
    for part, name in enumerate(PART_NAMES):
        if "_" not in name:
            continue
        side = name.split("_")[0]
        driving = JOINTS[part][JOINTS[part] >= 0] % len(PART_NAMES)
        assert all(PART_NAMES[joint].startswith(side) for joint in driving)


def sphere_model(parts: Parts, term: PoseTerm) -> BodyModel:
    m, p = len(REST), len(PART_NAMES)
    rows = SparseRows(
        names=PART_NAMES,
        pointers=np.arange(p + 1),
        indices=np.arange(p),
        weights=np.ones(p),
    )
    return BodyModel(
        gender="female",
        header={},
        triangles=TRIANGLES,
        mean_vertices=REST,
        shape_basis=np.zeros((2, m, 3)),
        part_names=PART_NAMES,
        part_parent=PART_PARENT,
        part_of_triangle=parts.part_of_triangle,
        triangle_weights=triangle_areas(REST, TRIANGLES),
        joint_regressor=rows,
        skinning_parts=parts.skinning_parts,
        skinning_weights=parts.skinning_weights,
        pose_feature_joints=JOINTS,
        pose_feature_strengths=term.strengths,
        incidence_pointers=parts.incidence_pointers,
        incidence_vertices=parts.incidence_vertices,
        pose_right_hand_sides=term.right_hand_sides.astype(np.float32),
        landmarks=rows,
        uv=np.zeros((1, 2)),
        uv_triangles=np.zeros_like(TRIANGLES),
        mirror=np.arange(m),
        lighter=undecimated(TRIANGLES, m),
        canonical_pose=np.zeros((p, 3)),
        standing_pose=np.zeros((p, 3)),
    )
