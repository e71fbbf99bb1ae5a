"""The documentation site. `make docs` builds it from this folder into service/docs_site."""

import hashlib
import os
import re
from functools import partial
from pathlib import Path

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

from service.version import VERSION

project = "Maquette"
author = "The Maquette authors"
project_copyright = author
version = release = VERSION

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
]
nitpicky = True
# What annotations of functions name has no page of its own.
nitpick_ignore_regex = [("py:.*", ".*")]

html_theme = "furo"
html_title = f"Maquette {release}"
html_math_renderer = "mathml"
html_show_sourcelink = False
html_copy_source = False
html_static_path = ["_static"]
html_css_files = ["cards.css"]

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 600
nb_merge_streams = True

autodoc_typehints = "signature"
napoleon_google_docstring = False

TAG = re.compile(r"\\tag\{(.*?)\}")
INLINE = re.compile(r"<script>(.*?)</script>", re.DOTALL)


def setup(app: Sphinx) -> None:
    """Formulas as MathML, which browsers draw themselves, and no inline scripts.

    So the service's policy need allow neither scripts and fonts from elsewhere nor inline ones.
    """
    app.add_html_math_renderer(
        "mathml", inline_renderers=(inline, None), block_renderers=(block, None)
    )
    app.connect("build-finished", move_scripts)


def inline(translator: HTML5Translator, node: nodes.math) -> None:
    translator.body.append(tex2mathml(node.astext(), as_block=False))
    raise nodes.SkipNode


def block(translator: HTML5Translator, node: nodes.math_block) -> None:
    """With its number beside it where it has one."""
    text = node.astext()
    number = TAG.search(text)
    translator.body.append(translator.starttag(node, "div", CLASS="math"))
    translator.body.append(tex2mathml(TAG.sub("", text), as_block=True))
    if number:
        translator.body.append(f'<span class="eqno">({number[1]})</span>')
    translator.body.append("</div>\n")
    raise nodes.SkipNode


def move_scripts(app: Sphinx, exception: Exception | None) -> None:
    """Give the theme's scripts files of their own."""
    if exception is not None or app.builder.format != "html":
        return
    root = Path(app.outdir)
    for page in root.rglob("*.html"):
        page.write_text(INLINE.sub(partial(_reference, page, root), page.read_text()))


def _reference(page: Path, root: Path, found: re.Match[str]) -> str:
    script = found[1]
    name = f"_static/inline-{hashlib.sha256(script.encode()).hexdigest()[:12]}.js"
    (root / name).write_text(script)
    return f'<script src="{os.path.relpath(root / name, page.parent)}"></script>'
