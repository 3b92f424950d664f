"""The measured rate and bandwidth of a topic."""

from __future__ import annotations

import pytest

from linkwright.graph.introspection.traffic import TrafficWindow

MILLISECOND_NS = 1_000_000
SECOND_NS = 1_000_000_000


def filled_window(count: int, period_ns: int, size: int = 100, **options) -> TrafficWindow:
    window = TrafficWindow(1000, **options)
    for number in range(count):
        window.add(number * period_ns, size + number)
    return window


def test_single_message_has_no_traffic():
    window = TrafficWindow(10)
    assert window.measure(0) is None
    window.add(0, 5)
    assert window.measure(SECOND_NS) is None


def test_steady_topic_has_expected_traffic():
    traffic = filled_window(11, 100 * MILLISECOND_NS).measure(SECOND_NS)
    assert traffic is not None
    assert traffic.messages_per_second == pytest.approx(10)
    assert traffic.bytes_per_second == pytest.approx(sum(range(100, 111)))
    assert (traffic.min_size, traffic.mean_size, traffic.max_size, traffic.count) == (100, 105, 110, 11)
    assert traffic.age_ns == SECOND_NS


def test_message_rate_stays_between_messages():
    window = filled_window(11, 100 * MILLISECOND_NS)
    assert window.measure(SECOND_NS + 150 * MILLISECOND_NS).messages_per_second == pytest.approx(10)


def test_traffic_rates_fall_in_silence():
    window = filled_window(11, 100 * MILLISECOND_NS)
    traffic = window.measure(10 * SECOND_NS)
    assert traffic.messages_per_second == pytest.approx(1)
    assert traffic.bytes_per_second < 120


def test_old_messages_are_dropped_except_last_two():
    window = filled_window(101, 100 * MILLISECOND_NS, max_age_ns=2 * SECOND_NS)
    assert window.measure(10 * SECOND_NS).count == 21
    assert window.measure(1000 * SECOND_NS).count == 2


def test_clock_jump_back_resets_window():
    window = filled_window(11, 100 * MILLISECOND_NS)
    window.add(-5 * SECOND_NS, 1)
    assert window.measure(-5 * SECOND_NS) is None
    assert window.measure(SECOND_NS) is None
