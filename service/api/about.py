"""What the OpenAPI document says about the service as a whole."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

SUMMARY: Final = "Human body shape, pose, light and measurements from a single picture."

DESCRIPTION: Final = """\
A picture and a few clicked points are posted to `/v1/fits`; the answer is a job, which is \
followed by its events or looked at now and then. Once it has succeeded, its result and its files \
are below it, and more can be made of it (derivations). Two to six pictures of one person go to \
`/v1/scans`. Points, initial poses and bodies are \
answered at once.

Every error is `application/problem+json` and says which field, why, and what to do about it."""

LICENCE: Final[Mapping[str, str]] = {"name": "Apache License 2.0", "identifier": "Apache-2.0"}

TAGS: Final[Sequence[Mapping[str, str]]] = (
    {"name": "fits", "description": "Jobs that fit a body to a picture."},
    {"name": "scans", "description": "Jobs that measure a person from several pictures."},
    {"name": "results", "description": "What a fit that has succeeded found, and its files."},
    {"name": "derivations", "description": "Jobs that make something of a fit or a scan."},
    {"name": "people", "description": "The labels of fits and scans."},
    {"name": "tokens", "description": "What browsers use in place of a key."},
    {"name": "images", "description": "Pictures that are uploaded once, for any number of fits."},
    {"name": "estimates", "description": "Points, initial poses and bodies, answered at once."},
    {"name": "body models", "description": "The bodies that are fitted."},
    {"name": "health", "description": "Whether the service is up, and its figures."},
    {"name": "problems", "description": "What the types of errors mean."},
)

SERVERS: Final[Sequence[Mapping[str, Any]]] = (
    {"url": "/", "description": "The service that this document was fetched from."},
)
