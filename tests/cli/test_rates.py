"""The numbers of ``topic hz``, ``delay`` and ``bw``, and their texts."""

from __future__ import annotations

import pytest

from linkwright.cli.topic.rates import BandwidthWindow, DelayWindow, RateWindow, Spread, format_rate, format_rate_table

MILLISECOND_NS = 1_000_000


def test_rate_window_measures_steady_rate():
    window = RateWindow(100)
    for tick in range(11):
        assert not window.add(tick * 100 * MILLISECOND_NS)
    spread = window.pop_spread()
    assert spread is not None
    assert format_rate(spread) == "average rate: 10.000\n\tmin: 0.100s max: 0.100s std dev: 0.00000s window: 10"


def test_rate_window_returns_spread_once():
    window = RateWindow(100)
    window.add(0)
    assert window.pop_spread() is None
    window.add(MILLISECOND_NS)
    assert window.pop_spread() is not None
    assert window.pop_spread() is None


def test_rate_window_drops_old_messages():
    window = RateWindow(2)
    for now in (0, 10 * MILLISECOND_NS, 20 * MILLISECOND_NS, 120 * MILLISECOND_NS):
        window.add(now)
    spread = window.pop_spread()
    assert spread is not None
    assert (spread.count, spread.minimum, spread.maximum) == (2, 10 * MILLISECOND_NS, 100 * MILLISECOND_NS)


def test_rate_window_restarts_when_time_jumps_back():
    window = RateWindow(10)
    window.add(100 * MILLISECOND_NS)
    window.add(200 * MILLISECOND_NS)
    assert window.add(50 * MILLISECOND_NS)
    assert window.pop_spread() is None


def test_rate_table_lists_several_topics():
    table = format_rate_table(
        {
            "/a": Spread(100 * MILLISECOND_NS, 90 * MILLISECOND_NS, 110 * MILLISECOND_NS, MILLISECOND_NS, 7),
            "/longer": Spread(MILLISECOND_NS, MILLISECOND_NS, MILLISECOND_NS, 0, 1000),
        }
    )
    assert table.splitlines() == [
        "  topic        rate       min_delta     max_delta      stddev     window ",
        "=" * 61,
        "/a          10.000       0.090         0.110         0.00100     7       ",
        "/longer     1000.000     0.001         0.001         0.00000     1000    ",
    ]


def test_delay_window_prints_average():
    window = DelayWindow(10)
    assert window.format_report() is None
    window.add(1000 * MILLISECOND_NS, 900 * MILLISECOND_NS)
    window.add(2000 * MILLISECOND_NS, 1700 * MILLISECOND_NS)
    assert window.format_report() == "average delay: 0.200\n\tmin: 0.100s max: 0.300s std dev: 0.10000s window: 2"
    assert window.format_report() == "no new messages"


@pytest.mark.parametrize(
    ("size", "printed"),
    [
        (100, "200 B/s from 2 messages\n\tMessage size mean: 100 B min: 100 B max: 100 B"),
        (5_000, "10.00 KB/s from 2 messages\n\tMessage size mean: 5.00 KB min: 5.00 KB max: 5.00 KB"),
        (2_000_000, "4.00 MB/s from 2 messages\n\tMessage size mean: 2.00 MB min: 2.00 MB max: 2.00 MB"),
    ],
)
def test_bandwidth_window_prints_rate(size, printed):
    window = BandwidthWindow(10)
    window.add(0, size)
    assert window.format_report(500 * MILLISECOND_NS) is None
    window.add(500 * MILLISECOND_NS, size)
    assert window.format_report(1000 * MILLISECOND_NS) == printed
