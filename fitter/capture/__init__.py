"""Faults of a picture that was taken to be measured, before any work is put into it.

One module for each kind of check: a pure function of a :class:`~fitter.capture.capture.Capture`,
which is a decoded picture with what a detector and the caller say of it.
:mod:`~fitter.capture.checking` calls them all. Every threshold was chosen on the tuning half of the
evaluation's pictures and degraded forms of them; ``service/docs/pictures.md`` has the figures.
"""
