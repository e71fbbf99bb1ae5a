"""Numba kernel of the silhouette energy."""

from typing import no_type_check

from numba import njit


@no_type_check
@njit(cache=True, fastmath=True)
def truncated_mismatch(model, image, to_image, to_model, truncation):
    """Sum over unmatched pixels of their truncated distance to the other region."""
    total = 0.0
    height, width = model.shape
    for i in range(height):
        for j in range(width):
            if model[i, j]:
                if not image[i, j]:
                    total += min(to_image[i, j], truncation)
            elif image[i, j]:
                total += min(to_model[i, j], truncation)
    return total
