"""The kernels that `maquette warm-up` compiled, for test processes: ``python -m tests.kernels``.

The service keeps them in one file (:mod:`service.worker.kernel_cache`), and whoever uses the fitter
without it has Numba's own files beside the code. These are laid there, so that no test process
compiles what is compiled already; nor does a wheel that is installed from the same sources.
"""

import filecmp
import os
import pickle
import shutil
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from fitter.numerics.checked_file import write_checked
from service.process.caches import KERNELS


def lay_beside_the_code() -> int:
    """Copy what is kept to where Numba looks for it; returns the number of files."""
    with TemporaryDirectory() as folder:
        os.environ[KERNELS] = folder
        # Imported here: Numba is to be loaded with that folder.
        from service.worker.kernel_cache import PACKAGE, restore_kernels

        restore_kernels()
        folders = {path.parent.name: path.parent for path in PACKAGE.rglob("__init__.py")}
        files = list(Path(folder).rglob("*.nb[ci]"))
        for path in files:
            # Its folder is called after that of the code, and a digest.
            code = folders[path.parent.name.rpartition("_")[0]]
            (code / "__pycache__").mkdir(exist_ok=True)
            shutil.copyfile(path, code / "__pycache__" / path.name)
    return len(files)


def hand_on(package: Path) -> None:
    """Give another installation's ``fitter``, of the same sources, what this one has compiled.

    Numba tells sources by their time and size, and names folders after where they are. Where
    nothing current is kept, the other installation compiles for itself.
    """
    from numba.core.caching import _CacheLocator

    from service.worker import kernel_cache

    def folder_of(source: Path) -> str:
        return str(_CacheLocator.get_suitable_cache_subpath(str(source)))

    kept = kernel_cache.read_kept()
    if kept is None or not kept.is_current():
        return
    renamed = {}
    for source in kept.sources:
        here, there = kernel_cache.PACKAGE / source, package / source
        assert filecmp.cmp(here, there, shallow=False), source
        shutil.copystat(here, there)
        renamed[folder_of(here)] = folder_of(there)
    files = {
        str(Path(renamed[folder]) / name): content
        for path, content in kept.files.items()
        for folder, _, name in [path.rpartition("/")]
    }
    with pytest.MonkeyPatch.context() as patch:
        # The file's name tells of which installation it is.
        patch.setattr(kernel_cache, "PACKAGE", package)
        place = next(kernel_cache._places())
    place.parent.mkdir(exist_ok=True)
    write_checked(place, [pickle.dumps(replace(kept, files=files))])


if __name__ == "__main__":
    print(f"{lay_beside_the_code()} files of compiled kernels.")
