"""Entries of a JSON file, each read with an error that names file and entry."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NoReturn, TypeVar, cast

import numpy as np
from jaxtyping import Float, Integer

from fitter.errors import MeshFolderError

T = TypeVar("T")

_KINDS: Mapping[type, str] = {str: "a text", dict: "an object", list: "a list"}


class Entries:
    """One JSON object of a file.

    Parameters
    ----------
    place
        What errors name: the file, and the object within it.
    values
        The object.
    """

    def __init__(self, place: str, values: Mapping[str, object]) -> None:
        self.place = place
        self.values = values

    def get(self, name: str, kind: type[T]) -> T:
        """The value of an entry that must be there and of this kind."""
        if name not in self.values:
            self.fail(name, "is missing", f"Write {_KINDS[kind]} there; OWN_BODIES.md shows it.")
        value = self.values[name]
        if not isinstance(value, kind):
            self.fail(name, f"is {_shown(value)}, expected {_KINDS[kind]}", "Write it anew.")
        return cast("T", value)

    def object(self, name: str) -> "Entries":
        """An entry that is an object itself."""
        return Entries(f"{self.place}: {name}", self.get(name, dict))

    def only(self, known: Sequence[str]) -> None:
        """Refuse entries nobody reads: most are misspelt."""
        for name in self.values:
            if name not in known:
                self.fail(name, "is not known", f"Expected are: {', '.join(known)}.")

    def fail(self, name: str, reason: str, remedy: str) -> NoReturn:
        """Raise the error that names this entry."""
        raise MeshFolderError(place=f"{self.place}: {name}", reason=reason, remedy=remedy)


def read_entries(path: Path, *, remedy: str) -> Entries:
    """Read a JSON object.

    Raises
    ------
    MeshFolderError
        If the file is missing (``remedy`` says what to write) or no JSON object.
    """
    if not path.is_file():
        raise MeshFolderError(place=path.name, reason=f"is missing in {path.parent}", remedy=remedy)
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise MeshFolderError(
            place=path.name, reason=f"is no JSON ({error})", remedy=remedy
        ) from error
    if not isinstance(values, dict):
        raise MeshFolderError(
            place=path.name, reason=f"is {_shown(values)}, expected an object", remedy=remedy
        )
    return Entries(path.name, values)


def whole_numbers(entries: Entries, name: str, folder: Path) -> Integer[np.ndarray, "..."]:
    """An array of indices: a list, or the name of an ``.npy`` file in the folder."""
    return _array(entries, name, folder, "iu", "whole numbers")


def numbers(entries: Entries, name: str, folder: Path) -> Float[np.ndarray, "..."]:
    """An array of finite numbers: a list, or the name of an ``.npy`` file in the folder."""
    array = _array(entries, name, folder, "iuf", "numbers").astype(np.float64)
    if not np.isfinite(array).all():
        entries.fail(name, "holds numbers that are not finite", "Write it anew.")
    return array


def _array(entries: Entries, name: str, folder: Path, kinds: str, wanted: str) -> np.ndarray:
    value = entries.values.get(name)
    try:
        if isinstance(value, str):
            array = np.load(folder / value, allow_pickle=False)
        else:
            array = np.array(entries.get(name, list))
    except (OSError, EOFError, ValueError) as error:
        entries.fail(name, f"cannot be read ({error})", "Give a list or the name of an .npy file.")
    if array.dtype.kind not in kinds:
        entries.fail(name, f"holds {array.dtype}, expected {wanted}", "Write it anew.")
    return array


def _shown(value: object) -> str:
    text = json.dumps(value)
    return text if len(text) < 60 else f"{text[:57]}..."
