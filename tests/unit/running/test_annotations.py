"""`make test-shapes` refuses what is not as announced, however often a function is defined."""

import numpy as np
import pytest
from jaxtyping import Float, TypeCheckError, jaxtyped

from tests.annotations import checked


def test_every_definition_of_a_function_is_checked():
    for rows in (2, 3):

        @jaxtyped(typechecker=checked)
        def stacked(
            above: Float[np.ndarray, "n 2"], below: Float[np.ndarray, "n 2"], rows: int = rows
        ) -> Float[np.ndarray, "2*n 2"]:
            return np.concatenate([above, below])[: 2 * rows]

        right = np.zeros((rows, 2))
        assert len(stacked(right, right)) == 2 * rows
        with pytest.raises(TypeCheckError, match="parameters"):
            stacked(right, np.zeros((rows + 1, 2)))
        with pytest.raises(TypeCheckError, match="return value"):
            stacked(np.zeros((4, 2)), np.zeros((4, 2)))


def test_functions_of_one_name_are_told_by_what_they_announce():
    @jaxtyped(typechecker=checked)
    def length(values: Float[np.ndarray, " n"]) -> int:
        return len(values)

    one = length

    @jaxtyped(typechecker=checked)
    def length(values: Float[np.ndarray, "n n"]) -> int:
        return len(values)

    assert (one(np.zeros(3)), length(np.zeros((3, 3)))) == (3, 3)
    with pytest.raises(TypeCheckError):
        one(np.zeros((3, 3)))
    with pytest.raises(TypeCheckError):
        length(np.zeros(3))
