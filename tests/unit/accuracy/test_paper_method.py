import numpy as np
import pytest

from fitter.fits import paper
from fitter.vocabulary.choices import Cues
from tests.accuracy.paper_method import (
    ADDED_TERMS,
    METHODS,
    OURS,
    PAPER,
    MethodError,
    method_errors,
    method_lines,
)
from tests.accuracy.table import MEASUREMENTS


def of(method: str, person: str, error: float) -> list[MethodError]:
    errors = {key: error for _, key, _ in MEASUREMENTS}
    return [MethodError(method=method, cues=cues, person=person, errors=errors) for cues in Cues]


def test_errors_are_absolute_and_their_spread_is_that_of_people():
    found = [
        each
        for method in METHODS
        for person, error in (("a", -4.0), ("a", 4.0), ("b", 2.0))
        for each in of(method, person, error if method == PAPER else 1.0)
    ]
    lines = method_lines(found)
    of_paper = next(line for line in lines if line.startswith(PAPER))
    # People have 4 and 2, the pictures 10 / 3 on the mean.
    assert of_paper.split(f"{PAPER}")[1].split()[1:4] == ["3.33", "±", "1.00"]
    assert "-2.33 ± 1.00" in lines[-1]


@pytest.mark.slow
def test_additions_are_energies_of_their_own(monkeypatch: pytest.MonkeyPatch):
    """What was added for one method is gone for the next."""
    seen: list[frozenset[str]] = []
    plain = paper.of_person

    def looked_at(known, views):
        seen.extend(view.counted for view in views if view.counted is not None)
        return plain(known, views)

    monkeypatch.setattr(paper, "of_person", looked_at)
    errors = method_errors("woman_young_heavy_standing")
    assert len(errors) == len(METHODS) * len(Cues)
    counts = [counted >= ADDED_TERMS for counted in seen]
    # Each of four methods asks for E1 and for E2; two of them count the clicks and the priors.
    assert counts == [False] * 4 + [True] * 4
    by = {(each.method, each.cues): each.errors["weight"] for each in errors}
    assert len(set(np.round(list(by.values()), 6))) == len(by)
    assert by[OURS, Cues.SES] != by[PAPER, Cues.SES]
