"""The documentation site. `make docs` builds it from this folder into service/docs_site."""

import logging
import os
import sys
from pathlib import Path

from service.version import VERSION

FOLDER = Path(__file__).parent
# Of this folder too where notebooks and galleries run, each in a process of its own.
sys.path.insert(0, str(FOLDER))
os.environ["PYTHONPATH"] = os.pathsep.join([str(FOLDER), os.environ.get("PYTHONPATH", "")])

project = "Maquette"
author = "The Maquette authors"
project_copyright = author
version = release = VERSION

extensions = [
    "_extensions.mathml",
    "_extensions.nothing_inline",
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = [
    "_extensions",
    "gallery_scripts",
    "sg_execution_times.rst",
    "gallery/sg_execution_times.rst",
    # The gallery's scripts in the forms in which they can be downloaded.
    *(f"gallery/*.{ending}" for ending in ("ipynb", "json", "md5", "py", "zip")),
]
nitpicky = True
# What annotations of functions name has no page of its own.
nitpick_ignore_regex = [("py:.*", ".*")]

html_theme = "furo"
html_title = f"Maquette {release}"
html_math_renderer = "mathml"
html_show_sourcelink = False
html_copy_source = False

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 600
nb_merge_streams = True

autodoc_typehints = "signature"
napoleon_google_docstring = False

sphinx_gallery_conf = {
    "examples_dirs": ["gallery_scripts"],
    "gallery_dirs": ["gallery"],
    "filename_pattern": "plot_",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "min_reported_time": 1_000_000,
}

logging.getLogger("httpx").setLevel(logging.WARNING)
