"""
A caricature
============

What distinguishes a body from the mean body of its height, multiplied. The height stays. The
person is the sample's.
"""

from _extensions.drawing import bodies_picture, sample_request, show

from fitter import fit
from fitter.applications.caricature import caricature_of_looks
from fitter.fits.prepared_model import prepared_model

result = fit(sample_request())
prepared = prepared_model(result.person.gender)
bodies = {}
for factor in (0.0, 1.0, 2.0):
    made = caricature_of_looks(prepared.operators.evaluator, result.person.body.shape, factor)
    bodies[f"times {factor:g}"] = prepared.measuring.canonical.at(made.shape)
show(bodies_picture(bodies, prepared.operators.model.triangles))
