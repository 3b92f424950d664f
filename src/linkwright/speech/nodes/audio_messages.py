"""Convert samples to messages of audio_common_msgs, and back from any format.

audio_capture publishes interleaved samples in one of GStreamer's formats (``S16LE``), which it announces on
``make_audio_info``. Without an AudioInfo, the format is audio_capture's default: 16 kHz, mono, S16LE.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.messages import get_message
from linkwright.speech.sound.resampling import MAX_RATE, MIN_RATE, Resampler, to_samples
from linkwright.speech.sound.samples import RATE, Samples

AUDIO_TYPE = "audio_common_msgs/msg/AudioData"
AUDIO_STAMPED_TYPE = "audio_common_msgs/msg/AudioDataStamped"
AUDIO_INFO_TYPE = "audio_common_msgs/msg/AudioInfo"

AUDIO_QUEUE_DEPTH = 100
"""The depth of the queues of `AUDIO_TYPE`: 10 s. With audio_capture's depth of 10, a process that is busy for 1 s loses
sound."""


WAVE = "wave"
"""The coding format of uncompressed samples."""

_MAX_CHANNELS = 64
_SAMPLE_FORMAT_PATTERN = re.compile(r"[SU]8|[SU](16|24|32)(LE|BE)|F(32|64)(LE|BE)")


@dataclass(frozen=True, slots=True)
class AudioFormat:
    """The format of the bytes in an AudioData, as an AudioInfo declares it.

    Attributes:
        channels: the number of channels; their samples are interleaved.
        rate: the sample rate of each channel, in Hz.
        sample_format: GStreamer's name, such as ``S16LE``, ``U8`` or ``F32LE``.
    """

    channels: int = 1
    rate: int = RATE
    sample_format: str = "S16LE"

    def __post_init__(self) -> None:
        """Check that the format is supported.

        Raises:
            LinkwrightError: VOICE411, sound in this format is not supported.
        """
        if not 1 <= self.channels <= _MAX_CHANNELS:
            raise _format_error(phrase("it has {channels} channels", channels=self.channels))
        if not MIN_RATE <= self.rate <= MAX_RATE:
            raise _format_error(phrase("its rate is {rate} Hz", rate=self.rate))
        if _SAMPLE_FORMAT_PATTERN.fullmatch(self.sample_format) is None:
            raise _format_error(phrase("its sample format is '{format}'", format=self.sample_format))

    @classmethod
    def of(cls, info: Any) -> AudioFormat:
        """Return the format that an AudioInfo declares.

        Raises:
            LinkwrightError: VOICE411, sound in this format, such as MP3, is not supported.
        """
        if info.coding_format not in ("", WAVE):
            raise _format_error(phrase("its encoding is '{encoding}'", encoding=info.coding_format))
        return cls(info.channels, info.sample_rate, info.sample_format)


def _format_error(reason: Phrase) -> LinkwrightError:
    message = phrase("sound in this format is not supported: {reason}", reason=reason)
    hint = phrase("publish it with format 'wave', sample_format 'S16LE', sample_rate 16000 and channels 1")
    return LinkwrightError(Diagnostic("VOICE411", message, hint=hint))


class AudioReader:
    """A converter of a stream of AudioData to samples for engines: mono, 16 bits, 16 kHz.

    Args:
        audio_format: the format of the messages; None for 16 kHz, mono, S16LE.
    """

    def __init__(self, audio_format: AudioFormat | None = None) -> None:
        self._audio_format = audio_format or AudioFormat()
        self._is_engine_format = self._audio_format == AudioFormat()
        self._incomplete = b""
        self._resampler = None if self._audio_format.rate == RATE else Resampler(self._audio_format.rate)

    @property
    def audio_format(self) -> AudioFormat:
        """The format of the messages."""
        return self._audio_format

    def read(self, data: bytes | bytearray | memoryview | NDArray[np.uint8] | Sequence[int]) -> Samples:
        """Return the samples of the next AudioData.

        An incomplete sample at the end is kept for the next call.
        """
        available = self._incomplete + bytes(data)
        if self._is_engine_format:  # a fast path, because this runs ten times a second all day
            used_bytes = len(available) // 2 * 2
            self._incomplete = available[used_bytes:]
            return np.frombuffer(available[:used_bytes], "<i2").astype(np.int16)
        values = _decode_values(available, self._audio_format)
        frames = len(values) // self._audio_format.channels
        used_bytes = frames * self._audio_format.channels * _get_sample_bytes(self._audio_format)
        self._incomplete = available[used_bytes:]
        mono: NDArray[np.float64] = values[: frames * self._audio_format.channels].reshape(frames, -1).mean(axis=1)
        return to_samples(mono) if self._resampler is None else self._resampler.feed(mono)


def _get_sample_bytes(audio_format: AudioFormat) -> int:
    return int(re.sub(r"\D", "", audio_format.sample_format)) // 8


def _decode_values(data: bytes, audio_format: AudioFormat) -> NDArray[np.float64]:
    """Return the samples in the data as numbers from -1 to 1, with interleaved channels.

    An incomplete last sample is dropped.
    """
    size, kind = _get_sample_bytes(audio_format), audio_format.sample_format[0]
    order = ">" if audio_format.sample_format.endswith("BE") else "<"
    data = data[: len(data) // size * size]
    if kind == "F":
        return np.frombuffer(data, f"{order}f{size}").astype(np.float64)
    if size == 3:
        widened = np.zeros((len(data) // 3, 4), np.uint8)
        packed = np.frombuffer(data, np.uint8).reshape(-1, 3)
        widened[:, 1:] = packed if order == "<" else packed[:, ::-1]
        raw: NDArray[np.float64] = widened.reshape(-1).view("<i4" if kind == "S" else "<u4").astype(np.float64)
        size = 4
    else:
        raw = np.frombuffer(data, f"{order}{'i' if kind == 'S' else 'u'}{size}").astype(np.float64)
    full_scale = 2.0 ** (8 * size - 1)
    return raw / full_scale if kind == "S" else raw / full_scale - 1.0


def make_audio_info(audio_format: AudioFormat) -> Any:
    """Return the AudioInfo of a format, with the bit rate in kbit/s, as in audio_capture."""
    info = get_message(AUDIO_INFO_TYPE)()
    info.channels, info.sample_rate, info.sample_format = (
        audio_format.channels,
        audio_format.rate,
        audio_format.sample_format,
    )
    info.bitrate = audio_format.channels * audio_format.rate * 8 * _get_sample_bytes(audio_format) // 1000
    info.coding_format = WAVE
    return info


def make_audio_data(data: bytes) -> Any:
    """Return an AudioData with the bytes of samples."""
    message = get_message(AUDIO_TYPE)()
    message.data = np.frombuffer(data, np.uint8)
    return message


def make_audio_stamped(data: bytes, stamp: Any) -> Any:
    """Return an AudioDataStamped with the bytes of samples.

    Args:
        data: the bytes of the samples.
        stamp: the time of the first sample, a builtin_interfaces/Time.
    """
    message = get_message(AUDIO_STAMPED_TYPE)()
    message.header.stamp = stamp
    message.audio.data = np.frombuffer(data, np.uint8)
    return message
