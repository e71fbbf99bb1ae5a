"""A service for the tutorials: runs while pages are built; its address is in ``SERVICE``."""

import os
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory

from sphinx.application import Sphinx

from service.commands.demo import SERVE_COMMAND, running_service


def setup(app: Sphinx) -> dict[str, bool]:
    running = ExitStack()

    def start(_: Sphinx) -> None:
        folder = Path(running.enter_context(TemporaryDirectory(prefix="maquette-docs-")))
        log = running.enter_context((folder / "service.log").open("w"))
        client = running.enter_context(running_service(SERVE_COMMAND, folder / "data", log))
        os.environ["SERVICE"] = str(client.base_url)

    def stop(_: Sphinx, exception: Exception | None) -> None:
        running.close()

    app.connect("builder-inited", start)
    app.connect("build-finished", stop)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
