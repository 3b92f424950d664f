"""The extras of the distribution: libraries that a command asks for by name when they are not installed."""

from __future__ import annotations

from linkwright.diagnostics.diagnostic import Diagnostic, LinkwrightError
from linkwright.diagnostics.phrase import Phrase, phrase

EXTRAS = {
    "bag": "rosbags",
    "colcon": "colcon_core",
    "dds": "cyclonedds",
    "diagram": "pygraphviz",
    "image": "PIL",
    "mesh": "trimesh",
    "navigation": "scipy",
    "parquet": "pyarrow",
    "ray": "ray",
    "sim": "mujoco",
    "train": "torch",
    "vision": "onnxruntime",
    "voice": "vosk",
    "zenoh": "zenoh",
}
"""Name of the extra -> the module that is missing without it."""

APART = frozenset({"parquet", "ray", "train"})
"""Extras that ``linkwright[all]`` is without; it has all others (decision 0022)."""

_BY_MODULE = {**{module: extra for extra, module in EXTRAS.items()}, "cv2": "vision"}


def install_hint(extra: str) -> Phrase:
    """How to install an extra of `EXTRAS`."""
    return phrase("run pip install 'linkwright[{extra}]'", extra=extra)


def missing_extra(code: str, error: ModuleNotFoundError) -> LinkwrightError:
    """The error for a user who asks for what an extra is needed for.

    Args:
        code: of the finding.
        error: what the import of the library raised.

    Raises:
        ModuleNotFoundError: the same, when the module is that of no extra.
    """
    package = (error.name or "").partition(".")[0]
    if package not in _BY_MODULE:
        raise error
    message = phrase("the package '{package}' is not installed", package=package)
    return LinkwrightError(Diagnostic(code, message, hint=install_hint(_BY_MODULE[package])))
