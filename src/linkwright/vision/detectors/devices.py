"""The device of a network, and the check that only networks receive network options."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.settings import setting_error

_GPU_PATTERN = re.compile(r"(?:cuda(?::(\d+))?|(\d+))$")


def parse_gpu(device: str) -> str | None:
    """Return the number of the GPU that a device names, or None for the CPU.

    Args:
        device: ``cpu``, ``cuda``, ``cuda:0``, ``0``, or empty for the CPU.

    Raises:
        LinkwrightError: VISION109, the device has another form.
    """
    if device.lower() in ("", "cpu"):
        return None
    match = _GPU_PATTERN.match(device.lower())
    if match is None:
        raise setting_error("device", device, phrase("use 'cpu', or 'cuda:0' for the first GPU"))
    return match[1] or match[2] or "0"


def refuse_network_options(options: DetectorOptions) -> tuple[Phrase, ...]:
    """Raise an error if a detector without a network gets network options.

    Returns:
        A note that the requested GPU is not used, to log once; empty if no GPU was requested.

    Raises:
        LinkwrightError: VISION109, there are labels or an input size, or the device has a wrong form.
    """
    network_options = {"labels": options.labels, "imgsz": options.size and "x".join(map(str, options.size[::-1]))}
    for name, value in network_options.items():
        if value is not None:
            raise setting_error(name, value, phrase("this option is only for networks: leave it out"))
    if parse_gpu(options.device) is None:
        return ()
    return (phrase("this detector has no network to run on '{device}'; it uses the CPU", device=options.device),)
