"""Answers within a request: points, bodies of clicks and of measurements, meshes in other formats.

They take tenths of a second, so they are not jobs. The API loads no numerics: it sends questions
(``questions``) to the quick lane of :mod:`service.compute`, whose children run ``tasks`` by what
``answers`` has.
"""
