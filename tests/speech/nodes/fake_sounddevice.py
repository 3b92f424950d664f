"""A fake of sounddevice whose microphone receives samples from a test."""

from __future__ import annotations

import numpy as np

open_streams: list = []
RATES = {16_000}
DEVICES = {None, 0, "microphone"}


class PortAudioError(Exception):
    pass


def check_input_settings(device, channels, dtype, samplerate):
    query_devices(device, "input")
    if samplerate not in RATES:
        raise PortAudioError("Invalid sample rate [PaErrorCode -9997]")


def query_devices(device, kind):
    if device not in DEVICES:
        raise ValueError(f"No input device matching {device!r}")
    return {"default_samplerate": 48_000.0}


class InputStream:
    def __init__(self, device, samplerate, blocksize, channels, dtype, callback):
        assert (channels, dtype) == (1, "int16")
        self.rate, self.block, self.callback, self.is_started = samplerate, blocksize, callback, False
        open_streams.append(self)

    def start(self):
        self.is_started = True

    def close(self):
        open_streams.remove(self)

    def deliver(self, samples):
        self.callback(np.asarray(samples, np.int16)[:, None], len(samples), None, None)
