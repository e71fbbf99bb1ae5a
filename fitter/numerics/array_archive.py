"""Named arrays in one ``.npz`` file, without pickle; the same arrays give the same bytes."""

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np


def write_arrays(
    target: Path | io.BytesIO, arrays: Mapping[str, np.ndarray], *, compression: int
) -> None:
    """Write the arrays under their names, in their order, ``ZIP_STORED`` or ``ZIP_DEFLATED``."""
    with zipfile.ZipFile(target, "w") as archive:
        for name, array in arrays.items():
            # A fixed date: np.savez stamps the present one, and the bytes would never repeat.
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = compression
            with archive.open(entry, "w") as stream:
                np.lib.format.write_array(stream, array, allow_pickle=False)


def read_arrays(source: io.BytesIO | io.BufferedReader) -> dict[str, np.ndarray]:
    """Every array of the file by name.

    What numpy and zipfile raise on a cut, emptied, damaged or pickled file, or on a bare ``.npy``,
    is nowhere promised: a caller who reads what may be damaged catches ``Exception``.
    """
    with np.load(source, allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}
