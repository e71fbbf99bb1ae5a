"""``python -m fitter.training.dressed``: draw people, learn from them, write the weights."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from fitter.detection.worn_parts import HEAD_FILE
from fitter.training.dressed.learning import learned, write_head
from fitter.training.dressed.pictures import LABEL_COLOURS, dressed_picture
from fitter.training.dressed.samples import samples

FIRST: Final = 1_000_000
"""Number of the first picture: others are free for tests."""


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m fitter.training.dressed", description=__doc__)
    parser.add_argument("--pictures", type=int, default=1200)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--output", type=Path, default=HEAD_FILE)
    parser.add_argument("--sheet", type=Path, help="draw 24 pictures and their labels, and end")
    options = parser.parse_args(arguments)
    if options.sheet is not None:
        pairs = [dressed_picture(FIRST + number) for number in range(24)]
        tiles = [np.hstack([each.picture, LABEL_COLOURS[each.labels]]) for each in pairs]
        rows = [np.hstack(tiles[start : start + 4]) for start in range(0, 24, 4)]
        cv2.imwrite(str(options.sheet), np.vstack(rows)[:, :, ::-1])
        return 0
    found = samples(range(FIRST, FIRST + options.pictures), options.processes)
    print(f"{len(found.labels)} pixels of {options.pictures} pictures", flush=True)
    for line, head in learned(found, epochs=2, rng=np.random.default_rng(FIRST)):
        print(line, flush=True)
        write_head(options.output, head)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
