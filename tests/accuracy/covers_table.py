"""People with gloves, masks, beards, in other skin and cloth: how they are taken, and errors."""

from collections import Counter
from collections.abc import Sequence

import numpy as np

from fitter.vocabulary.choices import BodyRegion, Covering
from tests.accuracy.clothing_table import plus_minus
from tests.accuracy.covers import CoveredFit
from tests.accuracy.table import INTERVALS, MEASUREMENTS

LEVEL, DEVIATIONS = INTERVALS[1]
COMPARED = [each for each in MEASUREMENTS if each[0] != "navel"]
REGIONS = (BodyRegion.UPPER, BodyRegion.ARMS, BodyRegion.LOWER, BodyRegion.LEGS)


def covers_heading() -> str:
    """Above :func:`covers_line`: how many are taken for bare, closely and loosely covered; mean
    absolute errors with their standard errors (bias); how many of 100 true values are held."""
    regions = "".join(f"{region.value:>10s}" for region in REGIONS)
    errors = "".join(f"{f'{name} {unit}':>18s}" for name, _, unit in COMPARED)
    hold = f"{f'{LEVEL} % hold':>12s}"
    return f"{'bare/close/loose':28s}{'in':10s}{'n':>3s}{regions}{errors}{hold}  findings"


def covers_line(these: Sequence[CoveredFit]) -> str:
    """People of one kind."""
    first = these[0]
    worn = "clothes" if first.dressed else "underwear"
    line = f"{first.asked.kind:28s}{worn:10s}{len(these):3d}"
    for region in REGIONS:
        counts = Counter(each.worn[region] for each in these if region in each.worn)
        line += f"{'/'.join(str(counts[covering]) for covering in Covering):>10s}"
    for _, key, _ in COMPARED:
        errors = np.array([each.errors[key] for each in these])
        away = np.abs(errors)
        line += f"{f'{away.mean():.1f}{plus_minus(away, 1)} ({errors.mean():+.1f})':>18s}"
    held = [[_holds(each, key) for _, key, _ in COMPARED] for each in these]
    shares = [100.0 * float(np.mean(each)) for each in held]
    line += f"{f'{np.mean(shares):.0f}{plus_minus(shares, 0)}':>12s}"
    findings = Counter(code for each in these for code in each.findings)
    said = ", ".join(f"{code} {count}" for code, count in findings.most_common())
    return f"{line}  {said}".rstrip()


def _holds(each: CoveredFit, key: str) -> bool:
    return abs(each.errors[key]) <= DEVIATIONS * each.standard_errors[key]
