"""Read WAV files in any common format, and write them as 16 kHz mono.

Python's module `wave` reads neither floating point nor the extensible form that many recorders write.
"""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, foreign, missing_file_hint, phrase
from linkwright.files.input_files import read_file
from linkwright.speech.sound.resampling import HIGHEST_RATE, LOWEST_RATE, resample
from linkwright.speech.sound.samples import RATE, Samples

_LARGEST = 1 << 30  # bytes
_PCM, _FLOAT, _EXTENSIBLE = 1, 3, 0xFFFE
_OTHER_FORMS = {2: "ADPCM", 6: "A-law", 7: "mu-law", 0x11: "IMA ADPCM", 0x31: "GSM", 0x55: "MP3"}
_DEPTHS = {(_PCM, 8), (_PCM, 16), (_PCM, 24), (_PCM, 32), (_FLOAT, 32), (_FLOAT, 64)}


@dataclass(frozen=True, slots=True)
class _Form:
    """The format in the ``fmt`` chunk."""

    kind: int
    channels: int
    rate: int
    bits: int


def read_wav(path: str | os.PathLike[str]) -> Samples:
    """Read a WAV file: PCM of 8 to 32 bits or floating point, channels averaged, resampled to `RATE`.

    A truncated file, for example from a recorder that was killed, gives its existing samples.

    Raises:
        LinkwrightError: VOICE401, it cannot be read; VOICE402, it is not a WAV file, or its format is not supported.
    """
    shown = display_path(Path(path))
    try:
        data = read_file(path, _LARGEST)
    except OSError as error:
        message = phrase("cannot read '{path}': {reason}", path=shown, reason=foreign(error.strerror))
        raise LinkwrightError(Diagnostic("VOICE401", message, hint=missing_file_hint(Path(path)))) from None
    return parse_wav(data, shown)


def parse_wav(data: bytes, name: str) -> Samples:
    """Read the bytes of a WAV file.

    Args:
        data: all of the file.
        name: its name in errors.

    Raises:
        LinkwrightError: VOICE402, it is not a WAV file, or its format is not supported.
    """
    form, sound = _chunks(data, name)
    if (form.kind, form.bits) not in _DEPTHS:
        kind = _OTHER_FORMS.get(form.kind, "PCM" if form.kind == _PCM else f"0x{form.kind:04x}")
        raise _no_wav(
            name, phrase("its samples are {kind} of {bits} bits, which is not supported", kind=kind, bits=form.bits)
        )
    if not 1 <= form.channels <= 64:
        raise _no_wav(name, phrase("it has {channels} channels", channels=form.channels))
    if not LOWEST_RATE <= form.rate <= HIGHEST_RATE:
        raise _no_wav(
            name,
            phrase(
                "its rate is {rate} Hz, but {lowest} to {highest} Hz are supported",
                rate=form.rate,
                lowest=LOWEST_RATE,
                highest=HIGHEST_RATE,
            ),
        )
    frame = form.channels * form.bits // 8
    values = _values(sound[: len(sound) // frame * frame], form).reshape(-1, form.channels)
    if not np.isfinite(values).all():
        raise _no_wav(name, phrase("some of its samples are infinite or not numbers"))
    return resample(values.mean(axis=1), form.rate)


def wav_bytes(samples: Samples) -> bytes:
    """Return samples as the bytes of a WAV file: 16 bits, mono, at `RATE`."""
    sound = samples.astype("<i2").tobytes()
    head = struct.pack("<4sI4s4sIHHIIHH4sI", b"RIFF", 36 + len(sound), b"WAVE", b"fmt ", 16, _PCM, 1, RATE,
                       2 * RATE, 2, 16, b"data", len(sound))  # fmt: skip
    return head + sound


def _chunks(data: bytes, name: str) -> tuple[_Form, bytes]:
    """Return the format and the bytes of the samples."""
    if data[:4] != b"RIFF" or data[8:12] != b"WAVE":
        raise _no_wav(name, phrase("it does not begin like a WAV file"))
    form: _Form | None = None
    at = 12
    while at + 8 <= len(data):
        kind, size = data[at : at + 4], int.from_bytes(data[at + 4 : at + 8], "little")
        body = data[at + 8 : at + 8 + size]
        if kind == b"fmt " and len(body) >= 16:
            tag, channels, rate, _, _, bits = struct.unpack("<HHIIHH", body[:16])
            if tag == _EXTENSIBLE and len(body) >= 26:
                tag = int.from_bytes(body[24:26], "little")
            form = _Form(tag, channels, rate, bits)
        elif kind == b"data":
            if form is None:
                raise _no_wav(name, phrase("its samples are stored before the chunk with their format"))
            return form, body
        at += 8 + size + size % 2
    raise _no_wav(name, phrase("it contains no samples"))


def _values(sound: bytes, form: _Form) -> NDArray[np.float64]:
    """Return the samples of all channels, interleaved, full scale at 1."""
    if form.kind == _FLOAT:
        return np.frombuffer(sound, f"<f{form.bits // 8}").astype(np.float64)
    if form.bits == 8:
        return (np.frombuffer(sound, np.uint8).astype(np.float64) - 128.0) / 128.0
    if form.bits == 24:
        wide = np.zeros((len(sound) // 3, 4), np.uint8)
        wide[:, 1:] = np.frombuffer(sound, np.uint8).reshape(-1, 3)
        return wide.reshape(-1).view("<i4").astype(np.float64) / 2.0**31
    return np.frombuffer(sound, f"<i{form.bits // 8}").astype(np.float64) / 2.0 ** (form.bits - 1)


def _no_wav(name: str, why: Phrase) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic(
            "VOICE402",
            phrase("'{path}' cannot be read as a WAV file: {why}", path=name, why=why),
            hint=phrase("write it as PCM of 16 bits, as with 'ffmpeg -i FILE -ar 16000 -ac 1 OUT.wav'"),
        )
    )
