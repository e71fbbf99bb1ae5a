"""What expires is asked with a time that was seen to run evenly."""

from service.jobs.sweep import SETTLING_S, ClockGuard


class Clocks:
    def __init__(self) -> None:
        self.elapsed, self.set_ahead = 100.0, 0.0

    def monotonic(self) -> float:
        return self.elapsed

    def wall(self) -> float:
        return 1_000_000.0 + self.elapsed + self.set_ahead


def test_the_wall_clocks_time_is_given_while_it_runs_evenly():
    clocks = Clocks()
    guard = ClockGuard(wall=clocks.wall, monotonic=clocks.monotonic)
    clocks.elapsed += 5.0
    assert guard.settled_time() == 1_000_105.0


def test_none_is_given_for_a_while_after_a_jump_and_then_that_of_the_new_clock():
    clocks = Clocks()
    guard = ClockGuard(wall=clocks.wall, monotonic=clocks.monotonic)
    clocks.set_ahead = 90_000.0
    assert guard.settled_time() is None
    clocks.elapsed += 0.9 * SETTLING_S
    assert guard.settled_time() is None
    clocks.elapsed += 0.2 * SETTLING_S
    assert guard.settled_time() == clocks.wall()
