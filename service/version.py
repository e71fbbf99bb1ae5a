"""The version: of the HTTP API, the packages, the image and the documentation alike.

It is the only place that says it; the build reads it from here (pyproject.toml).
"""

VERSION = "2.0.0"
