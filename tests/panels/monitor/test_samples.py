"""Samples of plots: queues, thinning and frames."""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.page.protocol.monitor import SAMPLES_KIND, pack_samples
from linkwright.panels.monitor.plots import MAX_SENT_SAMPLES, SampleQueue, thin_out


def test_samples_are_taken_once_in_order():
    queue = SampleQueue()
    queue.add(1.0, math.nan, 5.0)
    queue.add(2.0, 1.5, 6.0)
    samples = queue.take()
    assert samples[0].tolist() == [1.0, 2.0]
    assert samples[2].tolist() == [5.0, 6.0]
    assert math.isnan(samples[1, 0])
    assert samples[1, 1] == 1.5
    assert queue.take().shape == (3, 0)


def test_unread_sample_queue_is_limited_and_keeps_extremes():
    queue = SampleQueue()
    for number in range(100_000):
        queue.add(number, number, 1e6 if number == 31_415 else float(number % 100))
        assert len(queue) < 5000
    samples = queue.take()
    assert samples.shape[1] <= MAX_SENT_SAMPLES
    assert 1e6 in samples[2]
    assert (np.diff(samples[0]) > 0).all()


@given(st.lists(st.floats(allow_infinity=False, width=32), min_size=1, max_size=400), st.sampled_from([2, 4, 10, 64]))
def test_thinning_keeps_minimum_and_maximum(values, max_count):
    samples = np.array([np.arange(len(values)), np.arange(len(values)), values], dtype=np.float64)
    thinned = thin_out(samples, max_count)
    assert thinned.shape[1] <= max(max_count, min(len(values), max_count))
    assert (np.diff(thinned[0]) > 0).all()
    if not np.isnan(values).all():
        assert np.nanmin(thinned[2]) == np.nanmin(samples[2])
        assert np.nanmax(thinned[2]) == np.nanmax(samples[2])


def test_sample_frame_is_packed():
    frame = pack_samples([(7, np.array([[1.0], [math.nan], [3.0]])), (9, np.zeros((3, 2)))])
    assert struct.unpack_from("<IIII", frame) == (SAMPLES_KIND, 2, 0, 0)
    assert struct.unpack_from("<II", frame, 16) == (7, 1)
    assert struct.unpack_from("<d", frame, 24) == (1.0,)
    assert struct.unpack_from("<d", frame, 40) == (3.0,)
    assert struct.unpack_from("<II", frame, 48) == (9, 2)
    assert len(frame) == 16 + 8 + 24 + 8 + 48


@pytest.mark.parametrize("count", [MAX_SENT_SAMPLES, MAX_SENT_SAMPLES - 1])
def test_thinning_returns_small_input_unchanged(count):
    samples = np.random.default_rng(1).random((3, count))
    assert thin_out(samples, MAX_SENT_SAMPLES) is samples
