"""Numba kernel of the silhouette energy."""

from typing import no_type_check

from numba import njit


@no_type_check
@njit(cache=True, fastmath=True)
def robust_mismatch(model, image, to_image, to_model, confidence, scale, floor):
    """Sum over unmatched pixels of confidence times ρ'(d), d the distance to the other region.

    Beyond ``scale`` a pixel costs at least ``floor``.
    """
    total = 0.0
    inverse = 1.0 / (scale * scale)
    height, width = model.shape
    for i in range(height):
        for j in range(width):
            if model[i, j]:
                if image[i, j]:
                    continue
                d = to_image[i, j]
            elif image[i, j]:
                d = to_model[i, j]
            else:
                continue
            damping = 1.0 + d * d * inverse
            cost = d / (damping * damping)
            if d > scale and cost < floor:
                cost = floor
            total += cost * confidence[i, j]
    return total
