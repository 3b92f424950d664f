"""audio_capture publishes files and microphones as audio_common does."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import LogLevel
from linkwright.nodes import NodeOptions
from linkwright.speech.nodes.audio_capture import AudioCapture, RobotAudioCapture
from linkwright.speech.sound.wav import encode_wav
from linkwright.testing.stepped import AsyncSteppedGraph
from tests.speech.nodes import fake_sounddevice

TONE = (np.arange(4_000) % 200 * 100 - 10_000).astype(np.int16)


@pytest.fixture
async def test():
    async with AsyncSteppedGraph() as graph:
        yield graph


@pytest.fixture
def wav(tmp_path):
    (tmp_path / "said.wav").write_bytes(encode_wav(TONE))
    return str(tmp_path / "said.wav")


@pytest.fixture
def sounddevice(monkeypatch):
    monkeypatch.setitem(sys.modules, "sounddevice", fake_sounddevice)
    yield fake_sounddevice
    assert fake_sounddevice.open_streams == []


def start_capture(test, node_type=AudioCapture, namespace="/", **parameters):
    return node_type(test.graph, NodeOptions(namespace=namespace, parameters=parameters))


def received_samples(messages):
    return np.concatenate([np.frombuffer(bytes(message), "<i2") for message in messages])


async def test_file_is_published_at_clock_rate(test, wav):
    start_capture(test, file=wav)
    await test.advance(1.0)  # sound without subscriptions is not stored
    info, audio, audio_stamped = (test.record(f"/{name}") for name in ("audio_info", "audio", "audio_stamped"))
    await test.advance(0.5)
    assert len(audio) == len(audio_stamped) == 5
    assert np.array_equal(received_samples([message.data for message in audio])[:4_000], TONE)
    assert not received_samples([message.data for message in audio])[4_000:].any()  # silence follows
    assert np.array_equal(received_samples([message.audio.data for message in audio_stamped])[:4_000], TONE)
    assert len({(message.header.stamp.sec, message.header.stamp.nanosec) for message in audio_stamped}) == 5
    assert (info.last.channels, info.last.sample_rate, info.last.sample_format) == (1, 16_000, "S16LE")


async def test_file_is_repeated_with_loop(test, wav):
    start_capture(test, RobotAudioCapture, file=wav, loop=True, chunk=2_000)
    recording = test.record("/audio/audio")
    await test.advance(0.6)
    assert np.array_equal(
        received_samples([message.data for message in recording])[:8_000], np.concatenate((TONE, TONE))
    )


async def test_topics_are_in_node_namespace(test, wav):
    start_capture(test, RobotAudioCapture, namespace="/ears", file=wav)
    recording = test.record("/ears/audio_stamped")
    await test.advance(0.2)
    assert len(recording) == 2


async def test_unsupported_audio_parameters_are_reported(test, wav):
    start_capture(test, file=wav, format="mp3", sample_rate=44_100)
    await test.settle()
    warnings = [record.text for record in test.log if record.level is LogLevel.WARN]
    assert warnings == [
        "parameter 'sample_rate' cannot be '44100': sound is published with '16000'",
        "parameter 'format' cannot be 'mp3': sound is published with 'wave'",
    ]


async def test_microphone_is_published(test, sounddevice):
    node = start_capture(test)
    recording = test.record("/audio_stamped")
    await test.settle()
    (stream,) = sounddevice.open_streams
    assert (stream.rate, stream.block, stream.is_started) == (16_000, 1_600, True)
    for first in (0, 1_600):
        stream.deliver(TONE[first : first + 1_600])
    await test.settle()
    assert np.array_equal(received_samples([message.audio.data for message in recording]), TONE[:3_200])
    node.close()


async def test_microphone_with_other_rate_is_resampled(test, sounddevice, monkeypatch):
    monkeypatch.setattr(sounddevice, "RATES", {48_000})
    node = start_capture(test, device="microphone")
    recording = test.record("/audio")
    await test.settle()
    (stream,) = sounddevice.open_streams
    assert (stream.rate, stream.block) == (48_000, 4_800)
    stream.deliver(np.full(9_600, 1_000))
    await test.settle()
    sound = received_samples([message.data for message in recording])
    assert 3_100 < len(sound) <= 3_200
    assert np.abs(sound[200:-200] - 1_000).max() <= 1
    node.close()


@pytest.mark.parametrize(
    ("parameters", "code"),
    [({"file": "nowhere.wav"}, "VOICE401"), ({"chunk": 0}, "VOICE414"), ({"device": "trumpet"}, "VOICE413")],
)
async def test_invalid_parameters_are_rejected(parameters, code, test, sounddevice):
    with pytest.raises(LinkwrightError) as error:
        start_capture(test, **parameters)
    assert error.value.diagnostics[0].code == code


async def test_missing_portaudio_suggests_browser_microphone(test, tmp_path, monkeypatch):
    (tmp_path / "sounddevice.py").write_text("raise OSError('PortAudio library not found')\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "sounddevice", raising=False)
    with pytest.raises(LinkwrightError) as error:
        start_capture(test)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "VOICE412"
    assert "PortAudio library not found" in str(diagnostic.message)
    assert "the browser" in str(diagnostic.hint)
