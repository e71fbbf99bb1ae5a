"""Answers within a request: points, bodies of clicks and of measurements, meshes in other formats.

They take tenths of a second, so they are not jobs. The API loads no numerics; it asks a separate
process that has models and detector in memory, one question at a time. ``port`` says what the API
needs, ``pool`` and ``process`` are the API's side, ``main`` and ``answers`` the process's.
"""
