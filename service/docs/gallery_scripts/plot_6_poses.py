"""
Other poses
===========

The fitted body in named poses: SCAPE deforms every triangle by its part's rotation and by the
pose of its joints, so that knees and elbows bulge as bodies do. Over HTTP this is the product
``pose``.
"""

import numpy as np
from _extensions.drawing import bodies_picture, sample_request, show

from fitter import BodyParameters, fit
from fitter.applications.poses import NAMED_POSES, named_pose
from fitter.applications.rig import rig_of
from fitter.fits.prepared_model import prepared_model

result = fit(sample_request())
operators = prepared_model(result.person.gender).operators
shape = result.person.body.shape
rig = rig_of(operators.model, shape)
bodies = {}
for name in NAMED_POSES:
    body = BodyParameters(pose=named_pose(rig, name), translation=np.zeros(3), shape=shape)
    bodies[name.replace("_", " ")] = operators.evaluator.body_frame_vertices(body)
names = list(bodies)
for start in range(0, len(names), 3):
    chosen = {name: bodies[name] for name in names[start : start + 3]}
    show(bodies_picture(chosen, operators.model.triangles))
