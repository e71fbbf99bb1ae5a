"""Which side of a cut a pixel prefers before its colour is seen.

Wood has the colour of skin and a shaded thigh that of the wall behind it; where colours mislead,
what is known of the person's place decides. Both sources are blurred: the detector's mask by its
resolution, a body by its error.
"""

from typing import Final

import cv2
import numpy as np

from fitter.arrays import GreyImage, Mask
from fitter.segmentation.trimap import body_size

WEIGHT: Final = 16.0
"""Nats of preference per unit of log-odds. Much, because the contrast between two neighbours of the
same colour weighs gamma = 50 nats and errors of mask and body are shared by whole limbs. Chosen on
tuning halves: DECISIONS.md, "GrabCut is told where the person is"."""

BODY_BLUR_SHARE: Final = 0.006
"""Standard deviation of a fitted body's outline about the person's, as a share of the person's
longer side: a centimetre on a standing adult."""

_LEAST_SEEN, _LEAST_COVERED = 0.02, 0.05
"""No pixel is surer than this of being background or, mirrored, the person: of the detector's mask
and of a body."""


def preference(seed: GreyImage, silhouette: Mask | None) -> GreyImage:
    """How much each pixel prefers to be the person, nats; negative for background.

    Parameters
    ----------
    seed
        (h, w) probability that a pixel shows the person, by the detector.
    silhouette
        (h, w) of a body fitted to the picture, if there is one yet.
    """
    nats = _log_odds(seed, _LEAST_SEEN)
    if silhouette is not None:
        sigma = BODY_BLUR_SHARE * body_size(silhouette, np.empty((0, 2, 2)))
        covered = cv2.GaussianBlur(silhouette.astype(np.float32), (0, 0), max(sigma, 0.5))
        nats = nats + _log_odds(covered, _LEAST_COVERED)
    return WEIGHT * nats


def _log_odds(probability: GreyImage, least: float) -> GreyImage:
    bounded = np.clip(probability, least, 1.0 - least)
    return np.log(bounded / (1.0 - bounded))
