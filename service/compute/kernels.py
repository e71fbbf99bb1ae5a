"""Compiled kernels: where Numba keeps them, and one fit of the sample that compiles them.

Numba keeps what it compiles beside the code, or in the folder that is named. ``python -m
service.compute.kernels`` compiles once an installation, and so does a fork server that finds
nothing. A process that may not write there, as in an image, has a folder with links to what lies
there.
"""

import hashlib
import importlib
import io
import json
import logging
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from api_schemas.fit import FitRequest
from service.process.supervisor import PYTHON
from service.process.work_folder import make_work_folder

LOG: Final = logging.getLogger(__name__)

VARIABLE: Final = "NUMBA_CACHE_DIR"

FILES: Final = "*.nb[ci]"
"""Numba's: an index for each kernel, and its code for each combination of types."""

SMALLER: Final = 4
"""Times, each side of the sample: a fit of this passes through the same code in half the time."""

MAX_PIXELS: Final = 1_000_000


def settle_folders() -> Path:
    """Settle all folders before the numerics are loaded; return the one for temporary files.

    A folder that the environment names stays. A process that has loaded Numba already has its own.
    """
    work = make_work_folder()
    # Set even to nothing, which is beside the code: a file of Numba's in the current folder would
    # else name a folder, whose kernels are run.
    named = os.environ.setdefault(VARIABLE, "")
    if not named and "numba" not in sys.modules and not os.access(package(), os.W_OK):
        link_kernels(work / "kernels")
        os.environ[VARIABLE] = str(work / "kernels")
    return work


def link_kernels(folder: Path, kept: Path | None = None) -> None:
    """Lay links into a folder for Numba's cache: to kernels beside the code, and to those kept."""
    for code, name in _folders():
        (folder / name).mkdir(mode=0o700, parents=True, exist_ok=True)
        places = [code / "__pycache__", *([] if kept is None else [kept / name])]
        for file in (file for place in places for file in place.glob(FILES)):
            link = folder / name / file.name
            link.unlink(missing_ok=True)
            link.symlink_to(file)


def compile_once() -> None:
    """Have all kernels compiled by another process, unless there are some."""
    named = os.environ.get(VARIABLE)
    if not any(Path(named or package()).rglob(FILES)):
        LOG.info("Kernels are compiled, which takes one to three minutes.")
        subprocess.run([*PYTHON, "-m", __name__], stdout=subprocess.DEVNULL, check=False)


def _forget_kernels(folder: Path) -> None:
    """Remove the kernels of a folder, and the files that its links lead to."""
    for file in folder.rglob(FILES):
        with suppress(OSError):
            file.resolve().unlink(missing_ok=True)
        file.unlink(missing_ok=True)


def package() -> Path:
    """The fitter's folder, found without loading it."""
    found = find_spec("fitter")
    assert found is not None
    return Path(next(iter(found.submodule_search_locations or ())))


def import_kernels() -> None:
    """Import all modules of kernels: Numba asks then whether it may keep them, and ends over a no.

    Training's are left out.
    """
    for source in sorted(package().rglob("_*kernels.py")):
        module = ".".join(source.relative_to(package().parent).with_suffix("").parts)
        if "training" not in source.parts:
            importlib.import_module(module)


def _folders() -> Iterator[tuple[Path, str]]:
    """The folders of code that have kernels, and what each is called in a folder for the cache.

    Numba names it so itself (:mod:`numba.core.caching`), which is not to be loaded for this.
    """
    for code in sorted({source.parent for source in package().rglob("_*kernels.py")}):
        yield code, f"{code.name}_{hashlib.sha1(str(code).encode()).hexdigest()}"


def make_kernels_ready(detector: Path | None = None) -> None:
    """Fit the sample, with the packaged models: kernels are the same for all.

    Numba runs the files of its cache as it finds them, and ends over one that is damaged. So they
    are made anew where the sample cannot be fitted.

    Raises
    ------
    ModelFileError
        If a model is missing or damaged.
    """
    from fitter.errors import ModelFileError

    try:
        fit_sample(detector)
    except ModelFileError:
        raise
    except Exception as error:
        LOG.warning("Kernels are compiled anew, as those kept are of no use: %r", error)
        _forget_kernels(Path(os.environ.get(VARIABLE) or package()))
        fit_sample(detector)


def fit_sample(detector: Path | None = None) -> bytes:
    """Fit the sample in small, and return the person.

    Fits are functions of their requests: nothing of the sample is left for them.
    """
    # Imported here: Numba reads once where its cache is.
    from service.compute.pipeline import fit_task
    from service.compute.tasks import OPTIONS, ChildSetup
    from service.demo_data.sample import load_sample
    from service.jobs.inputs import PERSON, SentPicture, named_pictures
    from service.submissions.submission import check_submission

    sample = load_sample()
    image, request = _smaller(sample.image, sample.request)
    pictures = [SentPicture(image, None)]
    checked = check_submission(request, pictures, max_pixels=MAX_PIXELS)
    setup = ChildSetup(name="sample", max_pixels=MAX_PIXELS, detector=detector)
    options = checked.request.model_dump_json().encode()
    return fit_task(setup, {OPTIONS: options, **named_pictures(pictures)}, lambda _: None)[PERSON]


def _smaller(image: bytes, request: bytes) -> tuple[bytes, FitRequest]:
    """The sample's picture and request, each side a fraction of what it was."""
    from PIL import Image

    with Image.open(io.BytesIO(image)) as picture:
        reduced = picture.reduce(SMALLER)
    encoded = io.BytesIO()
    reduced.save(encoded, "JPEG")
    asked = json.loads(request)
    for point in asked["views"][0]["points"].values():
        point["x"] /= SMALLER
        point["y"] /= SMALLER
    return encoded.getvalue(), FitRequest.model_validate_json(json.dumps(asked))


def _compile_all() -> None:
    """Compile what a fit calls, and what only a caricature does: where a surface crosses itself."""
    make_kernels_ready()

    from fitter.applications.caricature import caricature_of_most_unusual
    from fitter.fits.equipment import prepared_model
    from fitter.person.fitted_person import FittedPerson

    person = FittedPerson.from_bytes(fit_sample())
    operators = prepared_model(person.gender).operators
    caricature_of_most_unusual(operators.evaluator, person.body.shape, 1.1)


if __name__ == "__main__":
    print("Kernels are compiled, which takes one to three minutes where it has not been done yet.")
    settle_folders()
    _compile_all()
