"""Definitions for tests: what is said of a measurement, where it does not matter."""

from fitter.measurement.definitions import About, Agreement, SurveyDefinition, Unit


def about(name, unit=Unit.CENTIMETRES):
    survey = SurveyDefinition(
        fields=(), share=1.0, agreement=Agreement.ABSENT, definition="None.", difference="All."
    )
    return About(name=name, unit=unit, definition="A.", source="B.", survey=survey, iso=None)
