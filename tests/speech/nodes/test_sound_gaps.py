"""Stamps of sound, counted in samples, and the gaps between them."""

from __future__ import annotations

import numpy as np

from linkwright.speech.nodes.sound_gaps import SampleStamps, SoundGaps
from linkwright.speech.sound.samples import BLOCK_LENGTH

SECOND = 10**9
LENGTH = SECOND // 10


def stamps_of(arrivals):
    """Return the stamps of blocks of a tenth of a second that arrived at these seconds."""
    stamps = SampleStamps()
    return [stamps.compute_stamp(BLOCK_LENGTH, round(at * SECOND)) for at in arrivals]


def gaps_of(stamps):
    gaps = SoundGaps()
    return [gaps.measure_gap(stamp, BLOCK_LENGTH) for stamp in stamps]


def test_stamps_count_samples_despite_jitter():
    delays = np.random.default_rng(1).uniform(0, 0.08, 200)
    stamps = stamps_of(10.0 + 0.1 * np.arange(200) + delays)
    assert np.max(np.abs(np.diff(stamps) - LENGTH)) <= 0.01 * LENGTH
    assert not any(gaps_of(stamps))


def test_stalled_source_is_not_a_gap():
    arrivals = [10.0 + 0.1 * max(index, 40) if index >= 10 else 10.0 + 0.1 * index for index in range(100)]
    assert not any(gaps_of(stamps_of(arrivals)))


def test_stamps_follow_the_clock():
    stamps = stamps_of(10.0 + 0.1005 * np.arange(2000))  # the clock of the microphone is slow by 0.5 %
    assert abs(stamps[-1] - (10.0 + 0.1005 * 1999 - 0.1) * SECOND) < 0.01 * SECOND


def test_lost_blocks_are_reported_as_gap():
    stamps = stamps_of(10.0 + 0.1 * np.arange(20))
    gap_list = gaps_of(stamps[:10] + stamps[12:])
    assert np.allclose(gap_list, [0.0] * 10 + [0.2] + [0.0] * 7, atol=0.005)


def test_restarted_stream_has_no_gap():
    stamps = SampleStamps()
    first = [stamps.compute_stamp(BLOCK_LENGTH, round((10.0 + 0.1 * index) * SECOND)) for index in range(10)]
    stamps.restart()
    assert stamps.compute_stamp(BLOCK_LENGTH, 15 * SECOND) == 15 * SECOND - LENGTH
    gaps = SoundGaps()
    assert not any(gaps.measure_gap(stamp, BLOCK_LENGTH) for stamp in first)
    gaps.restart()
    assert gaps.measure_gap(15 * SECOND, BLOCK_LENGTH) == 0.0


def test_loss_reported_by_source_is_a_gap():
    stamps, gaps, gap_list = SampleStamps(), SoundGaps(), []
    for index in range(100):
        lost_seconds = 0.4 if index >= 10 and index % 10 == 0 else 0.0
        gap_list.append(
            gaps.measure_gap(
                stamps.compute_stamp(BLOCK_LENGTH, round((10.0 + 0.1 * index) * SECOND), lost_seconds), BLOCK_LENGTH
            )
        )
    assert [number for number, gap in enumerate(gap_list) if gap] == list(range(10, 100, 10))
    assert np.allclose([gap for gap in gap_list if gap], 0.4, atol=0.005)


def test_small_losses_are_accumulated_and_hide_no_large_one():
    stamps, gaps = SampleStamps(), SoundGaps()
    losses = {10: 0.01, 11: 0.04, 12: 0.03, 13: 0.5, 20: 0.02}
    result = [
        stamps.compute_stamp(BLOCK_LENGTH, round((10.0 + 0.1 * index) * SECOND), losses.get(index, 0.0))
        for index in range(30)
    ]
    gap_list = [gaps.measure_gap(stamp, BLOCK_LENGTH) for stamp in result]
    assert [number for number, gap in enumerate(gap_list) if gap] == [12, 13]
    assert np.allclose([gap_list[12], gap_list[13]], [0.08, 0.5], atol=0.005)


def test_small_jumps_of_arrival_stamps_are_not_gaps():
    gaps = SoundGaps()
    delays = [0, 0, 0, 0, 0.03, 0, 0.04, 0, 0, 0, 0, 0.03, 0, 0.04, 0]
    assert not any(
        gaps.measure_gap(round((10.0 + 0.1 * index + delay) * SECOND), BLOCK_LENGTH)
        for index, delay in enumerate(delays)
    )


def test_stamps_do_not_run_ahead_of_clock_for_any_reported_loss():
    stamps = SampleStamps()
    for index in range(20):
        time_ns = round((10.0 + 0.1 * index) * SECOND)
        assert stamps.compute_stamp(BLOCK_LENGTH, time_ns, 1000.0) <= time_ns + 2 * SECOND


def test_gap_is_reported_immediately_after_restart():
    gaps = SoundGaps()
    assert not any(gaps.measure_gap(round((10.0 + 0.1 * index) * SECOND), BLOCK_LENGTH) for index in range(5))
    gaps.restart()
    assert gaps.measure_gap(20 * SECOND, BLOCK_LENGTH) == 0.0
    assert gaps.measure_gap(20 * SECOND + 3 * LENGTH, BLOCK_LENGTH) == 0.2


def test_arrival_stamps_with_jitter_have_no_gaps():
    delays = np.random.default_rng(2).uniform(0, 0.2, 200)
    assert not any(gaps_of([round((10.0 + 0.1 * index + delays[index]) * SECOND) for index in range(200)]))


def test_clock_jumps_and_stalls_are_not_gaps():
    stamps = stamps_of(
        [10.0 + 0.1 * index for index in range(20)] + [11.9] * 40 + [3.0 + 0.1 * index for index in range(20)]
    )
    assert not any(gaps_of(stamps))
    assert stamps_of([0.0, 0.0]) == [0, LENGTH - LENGTH // 100]
