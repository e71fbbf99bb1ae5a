"""Numba kernel of the silhouette energy of loose clothes (:mod:`fitter.energies.ease`)."""

from typing import no_type_check

from numba import njit

from fitter.energies._silhouette_kernels import _distance_to, _runs

_FAR_REACHES = 2.0


@no_type_check
@njit(cache=True, fastmath=True)
def clothed_mismatch(
    model, image, to_image, confidence, cloth, full, scale, floor, far, tight, usual, reach, loose
):
    """Sum over unmatched pixels of confidence times the derivative of the outline's cost.

    ``model`` holds face ids. A pixel of the model outside the observed region costs what
    :func:`robust_mismatch` says, times ``tight``, plus the cost of the ease its nearest cloth would
    have. A pixel of the region that the model does not cover costs the former to the extent that it
    is bare and the latter, times ``loose``, to the extent that it is cloth; within the mean ease,
    ``usual`` times the sum of ``full``, the latter is a gain. What no ease explains costs at least
    ``floor``, so that a body does not become cheaper by leaving its clothes.
    """
    runs, counts = _runs(model)
    total = 0.0
    inverse, inverse_reach = 1.0 / (scale * scale), 1.0 / (reach * reach)
    farthest = max(far, 2.0 * usual + 3.0 * reach)
    height, width = model.shape
    for i in range(height):
        for j in range(width):
            covered = model[i, j] >= 0
            if covered == image[i, j]:
                continue
            share = cloth[i, j]
            mean = usual * (full[i, j, 0] + full[i, j, 1])
            bare_farthest = farthest if share > 0.01 else far
            d = to_image[i, j] if covered else _distance_to(runs, counts, i, j, bare_farthest)
            damping = 1.0 + d * d * inverse
            bound = d / (damping * damping)
            if d > scale and bound < floor:
                bound = floor
            # Distances to the model are between centres, half a pixel more than to its outline.
            beyond = mean + d if covered else d - 0.5 - mean
            damping = 1.0 + beyond * beyond * inverse_reach
            ease = beyond / (damping * damping)
            if not covered:
                bound *= 1.0 - share
                if beyond > _FAR_REACHES * reach and bound < floor:
                    bound = floor
            total += confidence[i, j] * (tight * bound + loose * share * ease)
    return total
