"""
The height-preserving shape space
=================================

Coefficient 0 is the height's own axis, and all others leave the height as it is (section 4 of
the paper). Each row is one coefficient at minus two, zero and plus two standard deviations.
"""

import numpy as np
from _extensions.drawing import bodies_picture, show

from fitter import Gender, estimate_body
from fitter.fits.prepared_model import prepared_model

prepared = prepared_model(Gender.MALE)
triangles = prepared.operators.model.triangles
mean = estimate_body(Gender.MALE, {}).shape
for coefficient in range(4):
    bodies = {}
    for deviation in (-2, 0, 2):
        shape = np.zeros_like(mean)
        shape[coefficient] = deviation
        bodies[f"coefficient {coefficient}: {deviation:+d} SD"] = prepared.measuring.canonical.at(
            shape
        )
    show(bodies_picture(bodies, triangles))
