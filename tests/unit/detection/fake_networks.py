"""Networks whose answers a test chooses."""

from collections.abc import Callable, Mapping

import numpy as np

Outputs = Mapping[tuple[int, ...], np.ndarray]


class FakeNetwork:
    """Answers what ``answer`` makes of the picture it is shown."""

    def __init__(self, answer: Callable[[np.ndarray], Outputs]) -> None:
        self._answer = answer

    def outputs(self, picture: np.ndarray) -> Outputs:
        return self._answer(picture)
