"""Numba kernel of the silhouette energy of loose clothes (:mod:`fitter.energies.ease`)."""

from typing import no_type_check

from numba import njit

from fitter.energies._silhouette_kernels import _distance_to, _runs

_FAR_REACHES = 2.0


@no_type_check
@njit(cache=True, fastmath=True)
def clothed_mismatch(
    model, image, to_image, confidence, cloth, scale, floor, far, tight, mean, reach, loose
):
    """Sum over unmatched pixels of confidence times the derivative of the outline's cost.

    ``model`` holds face ids. A pixel of the model beyond the observed region costs as
    :func:`robust_mismatch` says, times ``tight``, and the ease that its nearest cloth would have;
    a pixel of the region that the model does not cover costs the one as far as it is bare and the
    other, times ``loose``, as far as it is cloth, which within the ``mean`` ease is a gain. What no
    ease explains costs ``floor`` at least: a body that has left its clothes is not the cheaper for
    it.
    """
    runs, counts = _runs(model)
    total = 0.0
    inverse, inverse_reach = 1.0 / (scale * scale), 1.0 / (reach * reach)
    farthest = max(far, mean + 3.0 * reach)
    height, width = model.shape
    for i in range(height):
        for j in range(width):
            covered = model[i, j] >= 0
            if covered == image[i, j]:
                continue
            share = cloth[i, j]
            bare_farthest = farthest if share > 0.01 else far
            d = to_image[i, j] if covered else _distance_to(runs, counts, i, j, bare_farthest)
            damping = 1.0 + d * d * inverse
            bound = d / (damping * damping)
            if d > scale and bound < floor:
                bound = floor
            # To the model d is from centre to centre, half a pixel more than from its outline.
            beyond = mean + d if covered else d - 0.5 - mean
            damping = 1.0 + beyond * beyond * inverse_reach
            ease = beyond / (damping * damping)
            if not covered:
                bound *= 1.0 - share
                if beyond > _FAR_REACHES * reach and bound < floor:
                    bound = floor
            total += confidence[i, j] * (tight * bound + loose * share * ease)
    return total
