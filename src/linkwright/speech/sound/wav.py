"""WAV files: reading of all common formats, and writing of 16 kHz mono files.

Python's module `wave` reads neither floating point nor the extensible format that many recorders write.
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
from linkwright.speech.sound.resampling import MAX_RATE, MIN_RATE, resample
from linkwright.speech.sound.samples import RATE, Samples

_MAX_FILE_BYTES = 1 << 30  # in bytes
_PCM, _FLOAT, _EXTENSIBLE = 1, 3, 0xFFFE
_OTHER_FORMATS = {2: "ADPCM", 6: "A-law", 7: "mu-law", 0x11: "IMA ADPCM", 0x31: "GSM", 0x55: "MP3"}
_SUPPORTED_FORMATS = {(_PCM, 8), (_PCM, 16), (_PCM, 24), (_PCM, 32), (_FLOAT, 32), (_FLOAT, 64)}


@dataclass(frozen=True, slots=True)
class _WavFormat:
    """The format that the ``fmt`` chunk declares."""

    kind: int
    channels: int
    rate: int
    bits: int


def read_wav(path: str | os.PathLike[str]) -> Samples:
    """Read a WAV file with PCM of 8 to 32 bits or floating-point samples.

    The channels are averaged, and the result is resampled to `RATE`. From a truncated file, such as one of a recorder
    that was killed, the samples that it contains are returned.

    Raises:
        LinkwrightError: VOICE401, the file cannot be read; VOICE402, it is not a WAV file, or its format is not
            supported.
    """
    path_text = display_path(Path(path))
    try:
        data = read_file(path, _MAX_FILE_BYTES)
    except OSError as error:
        message = phrase("cannot read '{path}': {reason}", path=path_text, reason=foreign(error.strerror))
        raise LinkwrightError(Diagnostic("VOICE401", message, hint=missing_file_hint(Path(path)))) from None
    return parse_wav(data, path_text)


def parse_wav(data: bytes, name: str) -> Samples:
    """Read the bytes of a WAV file.

    Args:
        data: the whole file.
        name: the name of the file in errors.

    Raises:
        LinkwrightError: VOICE402, it is not a WAV file, or its format is not supported.
    """
    wav_format, sample_bytes = _read_chunks(data, name)
    if (wav_format.kind, wav_format.bits) not in _SUPPORTED_FORMATS:
        format_name = _OTHER_FORMATS.get(
            wav_format.kind, "PCM" if wav_format.kind == _PCM else f"0x{wav_format.kind:04x}"
        )
        raise _wav_error(
            name,
            phrase(
                "its samples are {kind} with {bits} bits, which is not supported",
                kind=format_name,
                bits=wav_format.bits,
            ),
        )
    if not 1 <= wav_format.channels <= 64:
        raise _wav_error(name, phrase("it has {channels} channels", channels=wav_format.channels))
    if not MIN_RATE <= wav_format.rate <= MAX_RATE:
        raise _wav_error(
            name,
            phrase(
                "its rate is {rate} Hz, but {minimum} to {maximum} Hz are supported",
                rate=wav_format.rate,
                minimum=MIN_RATE,
                maximum=MAX_RATE,
            ),
        )
    frame_size = wav_format.channels * wav_format.bits // 8
    values = _decode_values(sample_bytes[: len(sample_bytes) // frame_size * frame_size], wav_format).reshape(
        -1, wav_format.channels
    )
    if not np.isfinite(values).all():
        raise _wav_error(name, phrase("some of its samples are infinite or NaN"))
    return resample(values.mean(axis=1), wav_format.rate)


def encode_wav(samples: Samples) -> bytes:
    """Return samples as the bytes of a WAV file: 16 bits, mono, at `RATE`."""
    sample_bytes = samples.astype("<i2").tobytes()
    header = struct.pack("<4sI4s4sIHHIIHH4sI", b"RIFF", 36 + len(sample_bytes), b"WAVE", b"fmt ", 16, _PCM, 1, RATE,
                       2 * RATE, 2, 16, b"data", len(sample_bytes))  # fmt: skip
    return header + sample_bytes


def _read_chunks(data: bytes, name: str) -> tuple[_WavFormat, bytes]:
    """Return the format, and the bytes of the samples."""
    if data[:4] != b"RIFF" or data[8:12] != b"WAVE":
        raise _wav_error(name, phrase("it has no WAV header"))
    wav_format: _WavFormat | None = None
    offset = 12
    while offset + 8 <= len(data):
        chunk_id, size = data[offset : offset + 4], int.from_bytes(data[offset + 4 : offset + 8], "little")
        body = data[offset + 8 : offset + 8 + size]
        if chunk_id == b"fmt " and len(body) >= 16:
            tag, channels, rate, _, _, bits = struct.unpack("<HHIIHH", body[:16])
            if tag == _EXTENSIBLE and len(body) >= 26:
                tag = int.from_bytes(body[24:26], "little")
            wav_format = _WavFormat(tag, channels, rate, bits)
        elif chunk_id == b"data":
            if wav_format is None:
                raise _wav_error(name, phrase("its 'data' chunk comes before its 'fmt ' chunk"))
            return wav_format, body
        offset += 8 + size + size % 2
    raise _wav_error(name, phrase("it contains no samples"))


def _decode_values(sample_bytes: bytes, wav_format: _WavFormat) -> NDArray[np.float64]:
    """Return the samples of all channels, interleaved, full scale at 1."""
    if wav_format.kind == _FLOAT:
        return np.frombuffer(sample_bytes, f"<f{wav_format.bits // 8}").astype(np.float64)
    if wav_format.bits == 8:
        return (np.frombuffer(sample_bytes, np.uint8).astype(np.float64) - 128.0) / 128.0
    if wav_format.bits == 24:
        widened = np.zeros((len(sample_bytes) // 3, 4), np.uint8)
        widened[:, 1:] = np.frombuffer(sample_bytes, np.uint8).reshape(-1, 3)
        return widened.reshape(-1).view("<i4").astype(np.float64) / 2.0**31
    return np.frombuffer(sample_bytes, f"<i{wav_format.bits // 8}").astype(np.float64) / 2.0 ** (wav_format.bits - 1)


def _wav_error(name: str, reason: Phrase) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic(
            "VOICE402",
            phrase("'{path}' cannot be read as a WAV file: {reason}", path=name, reason=reason),
            hint=phrase("convert it to 16-bit PCM, for example with 'ffmpeg -i FILE -ar 16000 -ac 1 OUT.wav'"),
        )
    )
