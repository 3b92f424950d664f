"""The finding that a computer cannot simulate a world as fast as requested."""

from math import inf

from linkwright.simulation.server.pace import PaceWatch


def codes_after(measurements, requested=1.0):
    """Return the code of each report, None for a recovery.

    A measurement is a factor and its duration in s.
    """
    reports = []
    watch = PaceWatch(reports.append)
    for factor, seconds in measurements:
        for _ in range(round(seconds / 0.5)):
            watch.add(factor, requested, 0.5)
    return [None if report is None else report.code for report in reports], reports


def test_slow_world_is_reported_once_until_it_recovers():
    codes, reports = codes_after([(0.42, 30), (1.0, 30), (0.3, 9), (1.0, 1), (0.3, 9)])
    assert codes == ["SIM146", None]
    assert "runs at 0.4 of real time" in str(reports[0].message)


def test_requested_slow_rate_is_not_reported():
    assert codes_after([(0.5, 60)], requested=0.5)[0] == []
    assert codes_after([(0.5, 60)], requested=inf)[0] == []
    assert codes_after([(0.85, 60)])[0] == []


def test_recovery_threshold_is_above_slow_threshold():
    assert codes_after([(0.5, 20), (0.85, 60)])[0] == ["SIM146"]
