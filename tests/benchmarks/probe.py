"""One figure of one checkout, printed as JSON: what :mod:`tests.benchmarks.against` runs in turns.

Run by its path with another checkout to import from, so only what both have is used.
"""

import json
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from fitter.fits.pipeline import fit
from fitter.request import FitRequest
from fitter.vocabulary.choices import Cues, ViewKind
from tests.benchmarks import upload
from tests.benchmarks.requests import suite_requests, warm_up
from tests.benchmarks.spent import timed, timed_fit
from tests.e2e.service import running_service
from tests.evaluation.files import read_case
from tests.evaluation.phone_cases import PHONE_PAIRS, PhonePair
from tests.evaluation.suite import fit_request
from tests.one_picture import changed, together

SMALL, LARGE = (480, 640), (960, 1280)


def fits(count: int) -> dict[str, float]:
    """Processor time of fits with shading, and of their pictures and meshes, at two sizes."""
    _warm_up_with_files()
    found: dict[str, float] = {}
    for width, height in (SMALL, LARGE):
        made = [timed_fit(each) for each in suite_requests(count, width=width, height=height)]
        size = f"{width}x{height}"
        found[f"SES fit, {size}"] = float(np.median([each.whole.processor_s for each in made]))
        found[f"pictures and meshes, {size}"] = float(
            np.median([each.export.processor_s for each in made])
        )
    return found


def uploads(count: int) -> dict[str, float]:
    """Wall time from the upload of twelve megapixels to the last file."""
    width, height = upload.SIZE
    with (
        tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder,
        running_service(Path(folder)) as client,
    ):
        taken = [
            upload._posted(client, each)["everything fetched"]
            for each in suite_requests(count + 1, width=width, height=height)
        ][1:]
    return {"upload of 12 megapixels to result and files": float(np.median(taken))}


def several(count: int) -> dict[str, float]:
    """Processor time of front and side as a share of one picture's."""
    warm_up()
    shares = [several_share(requests_of(pair)) for pair in list(PHONE_PAIRS.values())[:count]]
    return {"front and side over a single fit": float(np.median(shares))}


def requests_of(pair: PhonePair) -> list[FitRequest]:
    """Front and side, by silhouette, edges and shading."""
    return [
        changed(fit_request(read_case(case), Cues.SES), kind=kind)
        for case, kind in ((pair.front, ViewKind.FRONT), (pair.side, ViewKind.SIDE))
    ]


def several_share(requests: Sequence[FitRequest]) -> float:
    """Processor time of a fit of all pictures over that of one of them, on average."""
    _, both = timed(partial(fit, together(*requests)))
    single = [timed_fit(each).whole.processor_s for each in requests]
    return both.processor_s / float(np.mean(single))


def _warm_up_with_files() -> None:
    """Fit untimed, and make pictures and meshes once."""
    warm_up()
    width, height = SMALL
    for request in suite_requests(1, width=width, height=height):
        timed_fit(request)


PROBES: Mapping[str, Callable[[int], dict[str, float]]] = {
    "fits": fits,
    "uploads": uploads,
    "several": several,
}

if __name__ == "__main__":
    print(json.dumps(PROBES[sys.argv[1]](int(sys.argv[2]))))
