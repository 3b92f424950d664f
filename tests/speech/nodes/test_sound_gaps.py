"""Stamps of sound, counted in samples, and the gaps between them."""

from __future__ import annotations

import numpy as np

from linkwright.speech.nodes.sound_gaps import SampleStamps, SoundGaps
from linkwright.speech.sound.samples import BLOCK_LENGTH

SECOND_NS = 10**9
BLOCK_NS = SECOND_NS // 10


def stamp_blocks(arrivals):
    """Return the stamps of blocks of a tenth of a second that arrived at these seconds."""
    stamps = SampleStamps()
    return [stamps.compute_stamp(BLOCK_LENGTH, round(arrival * SECOND_NS)) for arrival in arrivals]


def find_gaps(stamps):
    gaps = SoundGaps()
    return [gaps.measure_gap(stamp, BLOCK_LENGTH) for stamp in stamps]


def test_stamps_count_samples_despite_jitter():
    delays = np.random.default_rng(1).uniform(0, 0.08, 200)
    stamps = stamp_blocks(10.0 + 0.1 * np.arange(200) + delays)
    assert np.max(np.abs(np.diff(stamps) - BLOCK_NS)) <= 0.01 * BLOCK_NS
    assert not any(find_gaps(stamps))


def test_stalled_source_is_not_a_gap():
    arrivals = [10.0 + 0.1 * max(index, 40) if index >= 10 else 10.0 + 0.1 * index for index in range(100)]
    assert not any(find_gaps(stamp_blocks(arrivals)))


def test_stamps_follow_the_clock():
    stamps = stamp_blocks(10.0 + 0.1005 * np.arange(2000))  # the clock of the microphone is slow by 0.5 %
    assert abs(stamps[-1] - (10.0 + 0.1005 * 1999 - 0.1) * SECOND_NS) < 0.01 * SECOND_NS


def test_lost_blocks_are_reported_as_gap():
    stamps = stamp_blocks(10.0 + 0.1 * np.arange(20))
    gap_list = find_gaps(stamps[:10] + stamps[12:])
    assert np.allclose(gap_list, [0.0] * 10 + [0.2] + [0.0] * 7, atol=0.005)


def test_restarted_stream_has_no_gap():
    stamps = SampleStamps()
    first = [stamps.compute_stamp(BLOCK_LENGTH, round((10.0 + 0.1 * index) * SECOND_NS)) for index in range(10)]
    stamps.restart()
    assert stamps.compute_stamp(BLOCK_LENGTH, 15 * SECOND_NS) == 15 * SECOND_NS - BLOCK_NS
    gaps = SoundGaps()
    assert not any(gaps.measure_gap(stamp, BLOCK_LENGTH) for stamp in first)
    gaps.restart()
    assert gaps.measure_gap(15 * SECOND_NS, BLOCK_LENGTH) == 0.0


def test_loss_reported_by_source_is_a_gap():
    stamps, gaps, gap_list = SampleStamps(), SoundGaps(), []
    for index in range(100):
        lost_seconds = 0.4 if index >= 10 and index % 10 == 0 else 0.0
        gap_list.append(
            gaps.measure_gap(
                stamps.compute_stamp(BLOCK_LENGTH, round((10.0 + 0.1 * index) * SECOND_NS), lost_seconds), BLOCK_LENGTH
            )
        )
    assert [number for number, gap in enumerate(gap_list) if gap] == list(range(10, 100, 10))
    assert np.allclose([gap for gap in gap_list if gap], 0.4, atol=0.005)


def test_small_losses_are_accumulated_and_hide_no_large_one():
    stamps, gaps = SampleStamps(), SoundGaps()
    losses = {10: 0.01, 11: 0.04, 12: 0.03, 13: 0.5, 20: 0.02}
    result = [
        stamps.compute_stamp(BLOCK_LENGTH, round((10.0 + 0.1 * index) * SECOND_NS), losses.get(index, 0.0))
        for index in range(30)
    ]
    gap_list = [gaps.measure_gap(stamp, BLOCK_LENGTH) for stamp in result]
    assert [number for number, gap in enumerate(gap_list) if gap] == [12, 13]
    assert np.allclose([gap_list[12], gap_list[13]], [0.08, 0.5], atol=0.005)


def test_small_jumps_of_arrival_stamps_are_not_gaps():
    gaps = SoundGaps()
    delays = [0, 0, 0, 0, 0.03, 0, 0.04, 0, 0, 0, 0, 0.03, 0, 0.04, 0]
    assert not any(
        gaps.measure_gap(round((10.0 + 0.1 * index + delay) * SECOND_NS), BLOCK_LENGTH)
        for index, delay in enumerate(delays)
    )


def test_stamps_do_not_run_ahead_of_clock_for_any_reported_loss():
    stamps = SampleStamps()
    for index in range(20):
        time_ns = round((10.0 + 0.1 * index) * SECOND_NS)
        assert stamps.compute_stamp(BLOCK_LENGTH, time_ns, 1000.0) <= time_ns + 2 * SECOND_NS


def test_gap_is_reported_immediately_after_restart():
    gaps = SoundGaps()
    assert not any(gaps.measure_gap(round((10.0 + 0.1 * index) * SECOND_NS), BLOCK_LENGTH) for index in range(5))
    gaps.restart()
    assert gaps.measure_gap(20 * SECOND_NS, BLOCK_LENGTH) == 0.0
    assert gaps.measure_gap(20 * SECOND_NS + 3 * BLOCK_NS, BLOCK_LENGTH) == 0.2


def test_arrival_stamps_with_jitter_have_no_gaps():
    delays = np.random.default_rng(2).uniform(0, 0.2, 200)
    assert not any(find_gaps([round((10.0 + 0.1 * index + delays[index]) * SECOND_NS) for index in range(200)]))


def test_clock_jumps_and_stalls_are_not_gaps():
    stamps = stamp_blocks(
        [10.0 + 0.1 * index for index in range(20)] + [11.9] * 40 + [3.0 + 0.1 * index for index in range(20)]
    )
    assert not any(find_gaps(stamps))
    assert stamp_blocks([0.0, 0.0]) == [0, BLOCK_NS - BLOCK_NS // 100]
