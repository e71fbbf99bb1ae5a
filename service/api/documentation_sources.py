"""The documentation from a clone, where nobody has built the site: its sources as plain pages.

Formulas, what notebooks print and the reference are the built site's alone (`make docs`).
"""

import html
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Final

from fastapi import FastAPI
from markdown_it import MarkdownIt
from starlette.requests import Request
from starlette.responses import FileResponse, RedirectResponse, Response

from service.api.problems import not_found
from service.api.security_headers import STATIC_SITE

SOURCES: Final = Path(__file__).parents[1] / "docs"
PICTURES: Final = ("service/demo_data", "fitter/measurement/atlas")
"""Folders of the clone whose pictures pages show: others may hold pictures of people."""

ENDINGS: Final = (".jpg", ".png", ".svg", ".webp")

_FRONT_MATTER: Final = re.compile(r"\A---\n.*?\n---\n", re.DOTALL)
_DIRECTIVE: Final = re.compile(r"^```\{(\w[\w-]*)\}(.*?)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_OPTION: Final = re.compile(r'^:([\w-]+): "?(.*?)"?$', re.MULTILINE)
_CARD: Final = re.compile(r"^:{3,}\{grid-item-card\} (.*?)\??$", re.MULTILINE)
_FENCE: Final = re.compile(r"^:{3,}.*\n|^:link(?:-type)?: .*\n|^:gutter: .*\n", re.MULTILINE)
_TARGET: Final = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")
_HEADING: Final = re.compile(r"<h([1-4])>(.*?)</h\1>")
_HEADERS: Final = {"Content-Security-Policy": STATIC_SITE, "Cache-Control": "no-cache"}

STYLE: Final = """
:root { color-scheme: light dark; font: 16px/1.55 system-ui, sans-serif; }
body { display: grid; grid-template-columns: 15rem minmax(0, 52rem); gap: 3rem; }
body { margin: 0 auto; max-width: 72rem; padding: 1.5rem; }
nav { font-size: 0.9rem; grid-column: 1; grid-row: 1; }
main { grid-column: 2; }
.to-pages { display: none; }
nav p { margin: 1.2rem 0 0.3rem; opacity: 0.7; }
nav a { display: block; padding: 0.15rem 0; }
a { color: light-dark(#0b57d0, #8ab4f8); text-decoration: none; }
a:hover { text-decoration: underline; }
img { max-width: 100%; }
pre { background: light-dark(#f3f3f3, #222); overflow-x: auto; padding: 0.8rem; }
code { font-size: 0.88em; }
table { border-collapse: collapse; display: block; overflow-x: auto; }
td, th { border-bottom: 1px solid light-dark(#ddd, #444); padding: 0.35rem 0.8rem 0.35rem 0; }
td, th { text-align: left; vertical-align: top; }
@media (max-width: 50rem) { body, .to-pages { display: block; } }
"""


class SourceSite:
    """The pages of a folder of Markdown, below a path of the service.

    Of MyST's directives it knows what the sources use: other files that are included, lists of
    pages, cells of notebooks, which are shown and not run, and cards.
    """

    def __init__(self, sources: Path, path: str) -> None:
        self._sources = sources
        self._root = sources.parents[1]
        self._path = path
        self._markdown = MarkdownIt("commonmark").enable("table")

    def page(self, name: str) -> str | None:
        """The page of this name, without an ending, as HTML; None if there is none."""
        address = f"{self._path}/{name}.html"
        pages = self._sources.rglob("*.md")
        source = next((each for each in pages if self._address(each) == address), None)
        if source is None:
            return None
        body = _HEADING.sub(_anchored, self._markdown.render(self._text(source)))
        title = html.escape(self._title(source))
        return (
            '<!doctype html><html lang="en"><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f'<title>{title}</title><link rel="icon" href="data:,">'
            f'<link rel="stylesheet" href="{self._path}/style.css">'
            # Where there is one column, the page comes before the list of all of them.
            f'<main><a class="to-pages" href="#pages">All pages</a>{body}</main>'
            f'<nav id="pages">{"".join(self._navigation())}</nav></html>'
        )

    def picture(self, name: str) -> Path | None:
        """A picture that pages show, by its path in the clone; None if there is none."""
        files = (each for folder in PICTURES for each in (self._root / folder).iterdir())
        shown = (each for each in files if each.suffix in ENDINGS)
        return next((each for each in shown if str(each.relative_to(self._root)) == name), None)

    def _text(self, source: Path) -> str:
        text = _CARD.sub(r"\n**\1.**", _FRONT_MATTER.sub("", source.read_text()))
        text = _FENCE.sub("", text)
        text = _TARGET.sub(lambda found: self._linked(found, source), text)
        return _DIRECTIVE.sub(lambda found: self._said(found, source), text)

    def _said(self, directive: re.Match[str], source: Path) -> str:
        kind, argument, body = directive[1], directive[2].strip(), directive[3]
        if kind == "include":
            options = dict(_OPTION.findall(body))
            text = self._text((source.parent / argument).resolve())
            text = text.partition(options["start-after"])[2] if "start-after" in options else text
            return text.partition(options["end-before"])[0] if "end-before" in options else text
        if kind == "toctree" and ":hidden:" in body:
            return ""
        if kind == "toctree":
            pages = (source.parent / f"{name}.md" for name in _entries(body))
            links = (
                f"- [{self._title(page)}]({self._address(page)})"
                if page.is_file()
                else f"- [{page.stem}](/docs)"
                for page in pages
            )
            return "\n".join(links)
        return f"```python\n{body}```"

    def _linked(self, found: re.Match[str], source: Path) -> str:
        image, label, target = found.groups()
        name, _, fragment = target.partition("#")
        if fragment.startswith("type-"):
            return f"[{label}](/docs)"
        if not name or "://" in target or target.startswith("/"):
            return found[0]
        file = (source.parent / name).resolve()
        if image:
            return f"![{label}]({self._path}/files/{file.relative_to(self._root.resolve())})"
        page = _including(self._sources).get(file, file)
        if page.is_file() and page.suffix == ".md" and page.is_relative_to(self._sources.resolve()):
            return f"[{label}]({self._address(page)}{'#' if fragment else ''}{fragment})"
        return f"[{label}](/docs)" if "reference/http" in name else label

    def _navigation(self) -> Iterator[str]:
        index = self._sources / "index.md"
        yield f'<a href="{self._path}/index.html"><b>Maquette</b></a><a href="/docs">The API</a>'
        for directive in _DIRECTIVE.finditer(index.read_text()):
            if directive[1] == "toctree":
                yield f"<p>{html.escape(dict(_OPTION.findall(directive[3]))['caption'])}</p>"
                for name in _entries(directive[3]):
                    page = self._sources / f"{name}.md"
                    if page.is_file():
                        title = html.escape(self._title(page))
                        yield f'<a href="{self._address(page)}">{title}</a>'

    def _address(self, page: Path) -> str:
        below = page.resolve().relative_to(self._sources.resolve()).with_suffix(".html")
        return f"{self._path}/{below}"

    def _title(self, page: Path) -> str:
        found = re.search(r"^# (.*)$", self._text(page), re.MULTILINE) if page.is_file() else None
        return found[1] if found else page.stem


def mount_sources(app: FastAPI, path: str, sources: Path = SOURCES) -> None:
    """Serve the sources as pages below a path."""
    site = SourceSite(sources, path)

    def begin(_: Request) -> Response:
        return RedirectResponse(f"{path}/index.html", status_code=307)

    def style(_: Request) -> Response:
        return Response(STYLE, media_type="text/css", headers=_HEADERS)

    def picture(request: Request) -> Response:
        found = site.picture(request.path_params["name"])
        if found is None:
            raise not_found(what="such picture")
        return FileResponse(found, headers=_HEADERS)

    def page(request: Request) -> Response:
        found = site.page(request.path_params["name"])
        if found is None:
            raise not_found(what="such page: `make docs` builds those of the reference")
        return Response(found, media_type="text/html", headers=_HEADERS)

    for below, answer in (
        ("", begin),
        ("/", begin),
        ("/style.css", style),
        ("/files/{name:path}", picture),
        ("/{name:path}.html", page),
    ):
        app.add_route(f"{path}{below}", answer, include_in_schema=False)


def _entries(body: str) -> list[str]:
    return [line for line in body.splitlines() if line and not line.startswith(":")]


@cache
def _including(sources: Path) -> dict[Path, Path]:
    """Pages that are another document, by that document."""
    return {
        (page.parent / found[2].strip()).resolve(): page.resolve()
        for page in sources.rglob("*.md")
        if (found := _DIRECTIVE.match(page.read_text())) and found[1] == "include"
    }


def _anchored(heading: re.Match[str]) -> str:
    text = re.sub(r"<[^>]+>", "", heading[2])
    anchor = re.sub(r"[^\w -]", "", html.unescape(text)).lower().replace(" ", "-")
    return f'<h{heading[1]} id="{anchor}">{heading[2]}</h{heading[1]}>'
