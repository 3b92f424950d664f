"""Sound on topics, in all formats that audio_capture may publish."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import Time, get_message
from linkwright.speech.nodes.audio_messages import (
    AudioFormat,
    AudioReader,
    make_audio_data,
    make_audio_info,
    make_audio_stamped,
)

TONE = np.sin(np.arange(1_600) * 2 * np.pi * 440 / 16_000) * 0.5


def encode_samples(values, sample_format):
    """Return values with full scale 1 in one of GStreamer's formats."""
    number_kind, order = sample_format[0], ">" if sample_format.endswith("BE") else "<"
    bits = int(sample_format[1:].rstrip("LBE"))
    if number_kind == "F":
        return values.astype(f"{order}f{bits // 8}").tobytes()
    integers = np.rint(values * 2.0 ** (bits - 1)).astype(np.int64) + (2 ** (bits - 1) if number_kind == "U" else 0)
    size = bits // 8
    return b"".join(
        int(sample).to_bytes(size, "big" if order == ">" else "little", signed=number_kind == "S")
        for sample in integers
    )


WHOLE = [f"{kind}{bits}{order}" for kind in "SU" for bits in (16, 24, 32) for order in ("LE", "BE")]


@pytest.mark.parametrize("name", ["S8", "U8", "F32LE", "F32BE", "F64LE", "F64BE", *WHOLE])
def test_sample_formats_are_converted(name):
    samples = AudioReader(AudioFormat(sample_format=name)).read(encode_samples(TONE, name))
    assert samples.dtype == np.int16
    assert np.abs(samples - TONE * 32_768).max() <= (256 if name.endswith("8") else 1)


def test_channels_are_averaged():
    stereo = np.column_stack((TONE, -TONE / 2)).reshape(-1)
    samples = AudioReader(AudioFormat(channels=2)).read(encode_samples(stereo, "S16LE"))
    assert np.abs(samples - TONE / 4 * 32_768).max() <= 1


@pytest.mark.parametrize("rate", [8_000, 44_100, 48_000])
def test_sample_rates_are_converted_to_engine_rate(rate):
    tone = np.sin(np.arange(rate) * 2 * np.pi * 440 / rate) * 0.5
    samples = AudioReader(AudioFormat(rate=rate)).read(encode_samples(tone, "S16LE"))
    expected = np.sin(np.arange(len(samples)) * 2 * np.pi * 440 / 16_000) * 0.5 * 32_768
    assert 15_900 < len(samples) <= 16_000
    assert np.abs(samples - expected)[200:-200].max() < 100


@pytest.mark.parametrize("channels", [1, 2])
def test_samples_can_be_split_between_messages(channels):
    data = encode_samples(np.column_stack((TONE,) * channels).reshape(-1), "S16LE")
    reader = AudioReader(AudioFormat(channels=channels))
    pieces = [reader.read(data[offset : offset + 33]) for offset in range(0, len(data), 33)]
    assert np.array_equal(np.concatenate(pieces), AudioReader(AudioFormat(channels=channels)).read(data))
    assert np.abs(np.concatenate(pieces) - TONE * 32_768).max() <= 1


def test_published_audio_messages_are_read():
    data = encode_samples(TONE, "S16LE")
    reader = AudioReader(AudioFormat.of(make_audio_info(AudioFormat())))
    message = make_audio_stamped(data, Time(sec=3))
    assert message.header.stamp.sec == 3
    assert np.array_equal(reader.read(message.audio.data), reader.read(make_audio_data(data).data))
    info = make_audio_info(AudioFormat())
    assert (info.channels, info.sample_rate, info.sample_format) == (1, 16_000, "S16LE")
    assert (info.coding_format, info.bitrate) == ("wave", 256)


@pytest.mark.parametrize(
    ("changed", "word"),
    [
        ({"coding_format": "mp3"}, "mp3"),
        ({"sample_format": "S17LE"}, "S17LE"),
        ({"channels": 0}, "0 channels"),
        ({"sample_rate": 7}, "7 Hz"),
    ],
)
def test_unsupported_audio_format_is_rejected(changed, word):
    info = get_message("audio_common_msgs/msg/AudioInfo")()
    for name, value in {"channels": 1, "sample_rate": 16_000, "sample_format": "S16LE", **changed}.items():
        setattr(info, name, value)
    with pytest.raises(LinkwrightError) as error:
        AudioFormat.of(info)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "VOICE411"
    assert word in str(diagnostic.message)
