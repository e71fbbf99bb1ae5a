"""Imported by the fork server of header readers: what it loads is shared, then it is confined."""

import os

import service.numerics.header_child  # noqa: F401
from service.process.confinement import write_only_below

write_only_below(os.environ["TMPDIR"])
