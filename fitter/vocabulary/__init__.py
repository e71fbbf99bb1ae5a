"""Words that requests, results and code share: choices, verdicts, names of points and measurements.

They are defined here once. The wire types (``api_schemas``) import them too, so nothing in this
package imports more than the standard library.
"""
