"""The kernels that `maquette warm-up` compiled, for test processes: ``python -m tests.kernels``.

The service keeps them in one file (:mod:`service.worker.kernel_cache`), and whoever uses the fitter
without it has Numba's own files beside the code. These are laid there, so that no test process
compiles what is compiled already.
"""

import os
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

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


if __name__ == "__main__":
    print(f"{lay_beside_the_code()} files of compiled kernels.")
