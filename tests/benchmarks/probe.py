"""Figures of one checkout, printed as JSON: what :mod:`tests.benchmarks.against` runs in turns.

Run by its path with another checkout to import from, so only what both have is used.
"""

import json
import sys

import numpy as np

from tests.benchmarks.requests import suite_requests, warm_up
from tests.benchmarks.spent import timed_fit

SMALL, LARGE = (480, 640), (960, 1280)


def figures(count: int) -> dict[str, float]:
    """Processor time of fits with shading, and of their pictures and meshes, at two sizes."""
    warm_up()
    for request in suite_requests(1, width=SMALL[0], height=SMALL[1]):
        timed_fit(request)
    found: dict[str, float] = {}
    for width, height in (SMALL, LARGE):
        made = [timed_fit(each) for each in suite_requests(count, width=width, height=height)]
        size = f"{width}x{height}"
        found[f"SES fit, {size}"] = float(np.median([each.fit_s for each in made]))
        found[f"pictures and meshes, {size}"] = float(np.median([each.export_s for each in made]))
    return found


if __name__ == "__main__":
    print(json.dumps(figures(int(sys.argv[1]))))
