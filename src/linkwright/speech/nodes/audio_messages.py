"""Convert sound to messages of audio_common_msgs, and from any of their formats.

audio_capture publishes interleaved samples in one of GStreamer's formats (``S16LE``), which it announces on
``audio_info``. Without an AudioInfo, the format is audio_capture's default: 16 kHz, mono, S16LE.
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
from linkwright.speech.sound.resampling import HIGHEST_RATE, LOWEST_RATE, Resampler, to_samples
from linkwright.speech.sound.samples import RATE, Samples

AUDIO = "audio_common_msgs/msg/AudioData"
AUDIO_STAMPED = "audio_common_msgs/msg/AudioDataStamped"
AUDIO_INFO = "audio_common_msgs/msg/AudioInfo"

AUDIO_DEPTH = 100
"""The depth of `AUDIO`'s queues: 10 s. audio_capture has 10, too few where a process is busy for 1 s."""


WAVE = "wave"
"""The coding format of samples that are not compressed."""

_MOST_CHANNELS = 64
_FORMAT = re.compile(r"[SU]8|[SU](16|24|32)(LE|BE)|F(32|64)(LE|BE)")


@dataclass(frozen=True, slots=True)
class AudioForm:
    """The format of the bytes in AudioData, as an AudioInfo declares it.

    Attributes:
        channels: the number of channels, whose samples are interleaved.
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
        if not 1 <= self.channels <= _MOST_CHANNELS:
            raise _unreadable(phrase("it has {channels} channels", channels=self.channels))
        if not LOWEST_RATE <= self.rate <= HIGHEST_RATE:
            raise _unreadable(phrase("its rate is {rate} Hz", rate=self.rate))
        if _FORMAT.fullmatch(self.sample_format) is None:
            raise _unreadable(phrase("its sample format is '{format}'", format=self.sample_format))

    @classmethod
    def of(cls, info: Any) -> AudioForm:
        """Read the format from an AudioInfo.

        Raises:
            LinkwrightError: VOICE411, sound in this format, such as MP3, is not supported.
        """
        if info.coding_format not in ("", WAVE):
            raise _unreadable(phrase("its encoding is '{coding}'", coding=info.coding_format))
        return cls(info.channels, info.sample_rate, info.sample_format)


def _unreadable(why: Phrase) -> LinkwrightError:
    message = phrase("sound in this format is not supported: {why}", why=why)
    hint = phrase("publish it with format 'wave', sample_format 'S16LE', sample_rate 16000 and channels 1")
    return LinkwrightError(Diagnostic("VOICE411", message, hint=hint))


class AudioReader:
    """Converts a stream of AudioData to samples for engines: mono, 16 bits, 16 kHz.

    Args:
        form: the format of the messages.
    """

    def __init__(self, form: AudioForm | None = None) -> None:
        self._form = form or AudioForm()
        self._is_as_engines_take_it = self._form == AudioForm()
        self._rest = b""
        self._resampler = None if self._form.rate == RATE else Resampler(self._form.rate)

    @property
    def form(self) -> AudioForm:
        """The format of the stream."""
        return self._form

    def read(self, data: bytes | bytearray | memoryview | NDArray[np.uint8] | Sequence[int]) -> Samples:
        """Return the samples of the next AudioData's field ``data``; an incomplete sample waits for its rest."""
        whole = self._rest + bytes(data)
        if self._is_as_engines_take_it:  # a fast path, because this runs ten times a second all day
            used = len(whole) // 2 * 2
            self._rest = whole[used:]
            return np.frombuffer(whole[:used], "<i2").astype(np.int16)
        values = _values(whole, self._form)
        frames = len(values) // self._form.channels
        used = frames * self._form.channels * _sample_bytes(self._form)
        self._rest = whole[used:]
        mono: NDArray[np.float64] = values[: frames * self._form.channels].reshape(frames, -1).mean(axis=1)
        return to_samples(mono) if self._resampler is None else self._resampler.feed(mono)


def _sample_bytes(form: AudioForm) -> int:
    return int(re.sub(r"\D", "", form.sample_format)) // 8


def _values(data: bytes, form: AudioForm) -> NDArray[np.float64]:
    """Return samples in the stream's channels and rate, full scale at 1; an incomplete sample is left out."""
    size, kind = _sample_bytes(form), form.sample_format[0]
    order = ">" if form.sample_format.endswith("BE") else "<"
    data = data[: len(data) // size * size]
    if kind == "F":
        return np.frombuffer(data, f"{order}f{size}").astype(np.float64)
    if size == 3:
        wide = np.zeros((len(data) // 3, 4), np.uint8)
        three = np.frombuffer(data, np.uint8).reshape(-1, 3)
        wide[:, 1:] = three if order == "<" else three[:, ::-1]
        raw: NDArray[np.float64] = wide.reshape(-1).view("<i4" if kind == "S" else "<u4").astype(np.float64)
        size = 4
    else:
        raw = np.frombuffer(data, f"{order}{'i' if kind == 'S' else 'u'}{size}").astype(np.float64)
    full = 2.0 ** (8 * size - 1)
    return raw / full if kind == "S" else raw / full - 1.0


def audio_info(form: AudioForm) -> Any:
    """Return the AudioInfo of a format; its bit rate is in kbit/s, as in audio_capture."""
    info = get_message(AUDIO_INFO)()
    info.channels, info.sample_rate, info.sample_format = form.channels, form.rate, form.sample_format
    info.bitrate = form.channels * form.rate * 8 * _sample_bytes(form) // 1000
    info.coding_format = WAVE
    return info


def audio_data(data: bytes) -> Any:
    """Return an AudioData with samples."""
    message = get_message(AUDIO)()
    message.data = np.frombuffer(data, np.uint8)
    return message


def audio_stamped(data: bytes, stamp: Any) -> Any:
    """Return an AudioDataStamped with samples.

    Args:
        data: the bytes of the samples.
        stamp: the time of the first sample, a builtin_interfaces/Time.
    """
    message = get_message(AUDIO_STAMPED)()
    message.header.stamp = stamp
    message.audio.data = np.frombuffer(data, np.uint8)
    return message
