"""Answers within a request: bodies of clicks and of measurements, and meshes in other formats.

They take a tenth of a second at most, so they are no jobs. The API loads no numerics; it asks a
process beside it that has the body models in memory, one question at a time. ``port`` says what the
API needs, ``pool`` and ``process`` are the API's side, ``main`` and ``answers`` the process's.
"""
