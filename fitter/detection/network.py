"""A network run on one thread."""

import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, runtime_checkable

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8

from fitter.arrays import Points2D


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


class ActivationNetwork:
    """A LiteRT model that takes one picture, with everything it computes on its way.

    Parameters
    ----------
    file
        As for :class:`Network`.
    """

    def __init__(self, file: Path) -> None:
        from ai_edge_litert.interpreter import Interpreter

        with _standard_error_withheld(), warnings.catch_warnings():
            # It warns that memory grows: by the activations, 40 MB here.
            warnings.simplefilter("ignore")
            self._interpreter = Interpreter(
                model_path=str(file), num_threads=1, experimental_preserve_all_tensors=True
            )
            self._interpreter.allocate_tensors()
        self._input = self._interpreter.get_input_details()[0]["index"]

    def activations(
        self, picture: Float32[np.ndarray, "s s 3"], wanted: Sequence[int]
    ) -> Mapping[int, np.ndarray]:
        """Some of the tensors for a picture, by their numbers, without the leading 1."""
        self._interpreter.set_tensor(self._input, picture[None])
        self._interpreter.invoke()
        return {each: self._interpreter.get_tensor(each)[0] for each in wanted}


def logistic(values: np.ndarray) -> Float[np.ndarray, "..."]:
    """1 / (1 + exp(-x)) of a network's outputs."""
    return 1.0 / (1.0 + np.exp(-np.clip(values.astype(np.float64), -50.0, 50.0)))


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


ANTIALIASED_FROM = 1.5
"""The picture is blurred before cropping above this many picture pixels per crop pixel."""

_BLUR_SHARE = 0.4


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SquareCrop:
    """Place of a square in the picture.

    Attributes
    ----------
    centre
        (2,) continuous pixels of the picture.
    side
        Length of a side, pixels of the picture.
    angle
        Clockwise rotation of the square in the picture, radians.
    size
        Side of the crop in its own pixels.
    """

    centre: Float[np.ndarray, "2"]
    side: float
    angle: float
    size: int

    @property
    def scale(self) -> float:
        """Picture pixels per crop pixel."""
        return self.side / self.size

    @property
    def rotation(self) -> Float[np.ndarray, "2 2"]:
        """From the crop's axes to the picture's."""
        cosine, sine = np.cos(self.angle), np.sin(self.angle)
        return np.array([[cosine, -sine], [sine, cosine]])

    def in_picture(self, points: Points2D) -> Points2D:
        """Continuous pixels of the crop as pixels of the picture."""
        return self.centre + self.scale * (points - 0.5 * self.size) @ self.rotation.T

    def cut_from(self, picture: UInt8[np.ndarray, "h w 3"]) -> UInt8[np.ndarray, "s s 3"]:
        """The square's pixels; black outside the picture."""
        if self.scale > ANTIALIASED_FROM:
            blur = _BLUR_SHARE * np.sqrt(self.scale**2 - 1.0)
            picture = cv2.GaussianBlur(picture, (0, 0), blur)
        return cv2.warpAffine(
            picture,
            self._between_pixel_centres(),
            (self.size, self.size),
            flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        )

    def put_back(
        self, values: Float[np.ndarray, "s s"], *, width: int, height: int
    ) -> Float[np.ndarray, "h w"]:
        """Resample values of the crop onto a picture of this size; 0 outside the crop."""
        return cv2.warpAffine(
            values,
            self._between_pixel_centres(),
            (width, height),
            flags=cv2.INTER_LINEAR,
        )

    def _between_pixel_centres(self) -> Float[np.ndarray, "2 3"]:
        """From crop to picture in OpenCV's convention: the first pixel's centre is (0, 0)."""
        turn = self.scale * self.rotation
        first = self.in_picture(np.array([[0.5, 0.5]]))[0] - 0.5
        return np.column_stack([turn, first])
