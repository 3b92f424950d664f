"""Parse devices of networks, and refuse network options for detectors without a network."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.settings import bad_setting

_GPU = re.compile(r"(?:cuda(?::(\d+))?|(\d+))$")


def gpu_of(device: str) -> str | None:
    """Return the GPU number of a device; None for the CPU.

    Args:
        device: ``cpu``, ``cuda``, ``cuda:0``, ``0``.

    Raises:
        LinkwrightError: VISION109, the device is unknown.
    """
    if device.lower() in ("", "cpu"):
        return None
    gpu = _GPU.match(device.lower())
    if gpu is None:
        raise bad_setting("device", device, phrase("use 'cpu', or 'cuda:0' for the first GPU"))
    return gpu[1] or gpu[2] or "0"


def without_network(options: DetectorOptions) -> tuple[Phrase, ...]:
    """Check that a detector without a network gets no network options.

    Returns:
        Notes to log once: that it does not need a GPU, if one was requested.

    Raises:
        LinkwrightError: VISION109, labels or an input size were given, or the device is unknown.
    """
    given = {"labels": options.labels, "imgsz": options.size and "x".join(map(str, options.size[::-1]))}
    for name, value in given.items():
        if value is not None:
            raise bad_setting(name, value, phrase("only networks have this option: leave it out"))
    if gpu_of(options.device) is None:
        return ()
    return (phrase("this detector has no network to run on '{device}'; it uses the CPU", device=options.device),)
