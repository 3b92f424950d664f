"""The microphone, accessed through PortAudio with the library sounddevice."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, install_hint, phrase
from linkwright.speech.sound.resampling import Resampler
from linkwright.speech.sound.samples import RATE, Samples

_FULL_SCALE = 32_768.0
"""The full scale of 16-bit samples."""


class Microphone:
    """A microphone that records until it is closed.

    A device that cannot be read at 16 kHz is read at its own rate and resampled.

    Args:
        device: a number or part of a name, as ``python -m sounddevice`` lists them; empty for the system's default.
        block_size: the approximate number of samples in a block.
        on_samples: called with each block, in a thread of PortAudio.

    Raises:
        LinkwrightError: VOICE412, PortAudio is missing; VOICE413, the device does not exist or cannot be opened.
    """

    def __init__(self, device: str, block_size: int, on_samples: Callable[[Samples], None]) -> None:
        sounddevice = _load_sounddevice()
        device_or_name: int | str | None = int(device) if device.isdigit() else device or None
        self._on_samples = on_samples
        self._resampler: Resampler | None = None
        try:
            rate = self._choose_rate(sounddevice, device_or_name)
            self._stream = sounddevice.InputStream(
                device=device_or_name,
                samplerate=rate,
                blocksize=block_size * rate // RATE,
                channels=1,
                dtype="int16",
                callback=self._receive,
            )
            self._stream.start()
        except (sounddevice.PortAudioError, ValueError, OSError) as error:
            message = phrase(
                "the microphone '{device}' cannot be opened: {reason}", device=device, reason=foreign(error)
            )
            hint = phrase(
                "run `python -m sounddevice` to list the devices, or use the browser's microphone, which "
                "needs no system device"
            )
            raise LinkwrightError(Diagnostic("VOICE413", message, hint=hint)) from None

    def close(self) -> None:
        """Stop recording."""
        self._stream.close()

    def _choose_rate(self, sounddevice: Any, device_or_name: int | str | None) -> int:
        try:
            sounddevice.check_input_settings(device=device_or_name, channels=1, dtype="int16", samplerate=RATE)
        except sounddevice.PortAudioError:
            rate: int = round(sounddevice.query_devices(device_or_name, "input")["default_samplerate"])
            self._resampler = Resampler(rate)
            return rate
        return RATE

    def _receive(self, data: Any, _frames: int, _time: Any, _status: Any) -> None:
        samples: Samples = np.array(data[:, 0], dtype=np.int16)
        self._on_samples(samples if self._resampler is None else self._resampler.feed(samples / _FULL_SCALE))


def _load_sounddevice() -> Any:
    hint = phrase(
        "install PortAudio (apt install libportaudio2), or use the browser's microphone, which needs no installation"
    )
    try:
        import sounddevice  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ModuleNotFoundError:
        message = phrase("the package '{package}' is not installed", package="sounddevice")
        raise LinkwrightError(Diagnostic("VOICE412", message, hint=install_hint("voice"))) from None
    except OSError as error:  # sounddevice is installed, but PortAudio is missing
        message = phrase("the system's microphone cannot be used: {reason}", reason=foreign(error))
        raise LinkwrightError(Diagnostic("VOICE412", message, hint=hint)) from None
    return sounddevice
