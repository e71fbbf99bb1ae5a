"""The process that reads the body models: the folder as its argument, a message as its output."""

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from api_schemas.body_models import BodyModels
from fitter.errors import ModelFileError
from service.worker.body_models.messages import (
    MODELS_MESSAGES,
    DescriptionMessage,
    ModelsMessage,
    UnusableModelsMessage,
)


def tell(describe: Callable[[Path | None], BodyModels]) -> None:
    """Describe the models of the folder named by the argument, without one the packaged ones."""
    folder = Path(sys.argv[1]) if sys.argv[1:] else None
    try:
        message: ModelsMessage = DescriptionMessage(body_models=describe(folder))
    except ModelFileError as error:
        message = UnusableModelsMessage(reason=str(error))
    # Not through sys.stdout, whose end would meet a reader that is gone where nobody can bear it.
    with suppress(BrokenPipeError):
        os.write(sys.stdout.fileno(), MODELS_MESSAGES.dump_json(message))
