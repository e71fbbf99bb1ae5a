"""Definitions for tests: what is said of a measurement, where it does not matter."""

from fitter.measurement.definitions import About, SurveyFields, Unit


def about(name, unit=Unit.CENTIMETRES):
    survey = SurveyFields(fields=(), share=1.0)
    return About(name=name, unit=unit, definition="A.", source="B.", survey=survey)
