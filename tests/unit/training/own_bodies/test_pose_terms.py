import numpy as np

from fitter.numerics.meshes import gradient_operator, part_laplacians
from fitter.training.assemble import ShapeSpace
from fitter.training.own_bodies.pose_terms import no_pose_term, transferred_pose_term
from tests.unit.training.own_bodies.bodies_folder import packaged, template


def space(mean: np.ndarray, basis: np.ndarray) -> ShapeSpace:
    model = packaged()
    return ShapeSpace(
        mean=mean,
        basis=basis,
        coefficients=np.zeros((1, len(basis))),
        laplacians=part_laplacians(
            gradient_operator(mean, model.triangles),
            model.triangle_weights,
            model.part_of_triangle,
            len(model.part_names),
        ),
    )


def test_a_term_taken_over_to_its_own_shape_space_is_itself():
    model = packaged()
    found = transferred_pose_term(space(model.mean_vertices, model.shape_basis), model)
    size = np.abs(model.pose_right_hand_sides).max()
    np.testing.assert_allclose(
        found.right_hand_sides, model.pose_right_hand_sides, atol=1e-4 * size
    )
    np.testing.assert_allclose(found.strengths, model.pose_feature_strengths, atol=1e-9)


def test_a_term_taken_over_to_another_mean_acts_there_as_it_did():
    """The new mean is the packaged body of some shape b: 1 + s . b there becomes 1 at its mean."""
    model = packaged()
    offset = np.zeros(len(model.shape_basis))
    offset[1] = 1.0
    mean = model.mean_vertices + model.shape_basis[1]
    found = transferred_pose_term(space(mean, model.shape_basis[:4]), model)
    at_mean = 1.0 + model.pose_feature_strengths @ offset
    kept = at_mean > 0.2
    np.testing.assert_allclose(
        (found.strengths * at_mean[..., None])[kept],
        model.pose_feature_strengths[..., :4][kept],
        atol=1e-6,
    )


def test_without_a_term_nothing_is_added():
    own = space(packaged().mean_vertices, packaged().shape_basis[:3])
    term = no_pose_term(own, template().mesh.parts)
    assert not term.right_hand_sides.any()
    assert term.strengths.shape[2] == 3
