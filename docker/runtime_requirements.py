"""Print what the service in a container needs: the dependencies, and the extras it is run with.

Further extras can be named after the project's file.
"""

import sys
import tomllib
from pathlib import Path

EXTRAS = ("s3", "tracing", "detector")

project = tomllib.loads(Path(sys.argv[1]).read_text())["project"]
wanted = [*project["dependencies"]]
for extra in (*EXTRAS, *sys.argv[2:]):
    wanted += project["optional-dependencies"][extra]
print(*wanted, sep="\n")
