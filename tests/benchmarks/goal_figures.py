"""The figures that have goals, each as the part that it belongs to measures it.

Parts are imported as they begin: this process has pages of a service's libraries from then on.
"""

from collections.abc import Mapping, Sequence

Figures = Mapping[str, Sequence[float]]
"""What was found, round by round, picture by picture or run by run."""

IDLE = "resident memory of `maquette serve`, one worker, idle"
OWN_COST = "the service's own cost on small SE fits"
DEMO = "`maquette demo`, warm"
SIMPLEX = "the paper's simplex over Gauss-Newton, same energy"
PROCESSES = "SES fits a second, two processes over one"

SERVICES = 2
PROBED = {"fits": 5, "uploads": 3}
SEVERAL = 3
SMALL_FITS = 60
"""In a row: the first of them is its process's first, and what that costs is shared by all."""
DEMOS = 3
SIMPLEX_PICTURES = 1
FITS_A_PROCESS = 10


def of_the_command() -> Figures:
    """Seconds and MiB of `maquette`, while this process shares no library with a service.

    The demo comes first: it compiles the kernels if they are not yet, and nothing idle does then.
    """
    from tests.benchmarks import demo, idle

    return {
        DEMO: demo.measured(DEMOS),
        IDLE: [each.share_mib for each in idle.measured(SERVICES)],
    }


def of_the_baseline(rounds: int) -> Figures:
    """Shares of what the baseline takes.

    Raises
    ------
    NoCheckoutError
        If the baseline cannot be had.
    """
    from tests.benchmarks import against
    from tests.benchmarks.checkouts import BASELINE, checkout_of

    with checkout_of(BASELINE) as baseline:
        compared = against.measured(baseline, fits=PROBED, rounds=rounds)
    return {each.name: each.ratios for each in compared}


def of_this_checkout() -> Figures:
    """Shares of something else that this checkout takes, and percent."""
    from tests.benchmarks import against, overhead, simplex, throughput

    several = against.figures(against.HERE, "several", SEVERAL)
    rates = throughput.measured(FITS_A_PROCESS)
    one, *_, most = (rates[processes] for processes in sorted(rates))
    return {name: [share] for name, share in several.items()} | {
        OWN_COST: [100.0 * (1.0 - each.served_share) for each in overhead.measured(SMALL_FITS)],
        SIMPLEX: [each.times_slower for each in simplex.measured(SIMPLEX_PICTURES)],
        PROCESSES: [most / one],
    }
