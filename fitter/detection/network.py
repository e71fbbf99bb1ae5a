"""A network run on one thread."""

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float32


@runtime_checkable
class PictureNetwork(Protocol):
    """A network that takes a picture."""

    def outputs(
        self, picture: Float32[np.ndarray, "s s 3"]
    ) -> Mapping[tuple[int, ...], np.ndarray]:
        """The network's outputs for a picture, keyed by their shapes without the leading 1.

        No two outputs of the networks used here have the same shape.
        """
        ...


class Network:
    """A LiteRT model that takes one picture; a :class:`PictureNetwork`.

    Parameters
    ----------
    file
        The model's file. It is mapped, not read: nothing may write to it as long as this is used.
    """

    def __init__(self, file: Path) -> None:
        from ai_edge_litert.interpreter import Interpreter

        with _standard_error_withheld():
            self._interpreter = Interpreter(model_path=str(file), num_threads=1)
            self._interpreter.allocate_tensors()
        self._input = self._interpreter.get_input_details()[0]["index"]
        self._outputs = self._interpreter.get_output_details()

    def outputs(
        self, picture: Float32[np.ndarray, "s s 3"]
    ) -> Mapping[tuple[int, ...], np.ndarray]:
        """See :class:`PictureNetwork`."""
        self._interpreter.set_tensor(self._input, picture[None])
        self._interpreter.invoke()
        return {
            tuple(each["shape"][1:].tolist()): self._interpreter.get_tensor(each["index"])[0]
            for each in self._outputs
        }


@contextmanager
def _standard_error_withheld() -> Iterator[None]:
    """Send what is written to file descriptor 2 nowhere.

    The library announces there by what it computes, with no way to turn that off, in the middle of
    its caller's log. What goes wrong it raises.
    """
    try:
        kept = os.dup(2)
    except OSError:
        # There is no standard error to keep quiet.
        yield
        return
    try:
        with Path(os.devnull).open("wb") as nowhere:
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
