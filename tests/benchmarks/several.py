"""Processor time of front and side in one fit over that of one picture's."""

from collections.abc import Iterator
from statistics import median

from fitter.fits.pipeline import fit
from fitter.request import FitRequest
from fitter.training.report.survey_comparison import note_lines
from fitter.vocabulary.choices import Cues, ViewKind
from tests.accuracy.cases import PHONE_PAIRS, PicturePair
from tests.accuracy.files import read_case
from tests.accuracy.true_picture import fit_request
from tests.benchmarks.requests import warm_up
from tests.benchmarks.spent import processor_s
from tests.one_picture import changed, together


def lines(count: int) -> Iterator[str]:
    """``count`` pairs."""
    shares = measured(count)
    yield from note_lines(
        f"Front and side over a single fit, {count} people: median {median(shares):.2f}, "
        f"{min(shares):.2f} to {max(shares):.2f}."
    )


def measured(count: int) -> list[float]:
    """The share of each pair."""
    warm_up()
    return [_share(pair) for pair in list(PHONE_PAIRS.values())[:count]]


def _share(pair: PicturePair) -> float:
    requests = _requests(pair)
    both = processor_s(lambda: fit(together(*requests)))
    single = [processor_s(lambda each=each: fit(each)) for each in requests]
    return both * len(single) / sum(single)


def _requests(pair: PicturePair) -> list[FitRequest]:
    """Front and side, by silhouette, edges and shading."""
    return [
        changed(fit_request(read_case(case), Cues.SES), kind=kind)
        for case, kind in ((pair.front, ViewKind.FRONT), (pair.side, ViewKind.SIDE))
    ]
