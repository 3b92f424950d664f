"""The extras of the distribution: optional libraries that commands name if they are not installed."""

from __future__ import annotations

import re
import sys

from linkwright.diagnostics.diagnostic import Diagnostic, LinkwrightError
from linkwright.diagnostics.phrase import Phrase, phrase
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.diagnostics.installation import Installation

EXTRAS = {
    "bag": "rosbags",
    "colcon": "colcon_core",
    "dds": "cyclonedds",
    "diagram": "pygraphviz",
    "image": "PIL",
    "lsp": "pygls",
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

_BY_MODULE = {**{module: extra for extra, module in EXTRAS.items()}, "cv2": "vision", "lsprotocol": "lsp"}


_VERSION = sys.version_info[:2]
_BEFORE = r"python_version < '(\d+)\.(\d+)'"  # not compiled here: few commands need it


def install_hint(extra: str, package: str = "") -> Phrase:
    """How to install an extra of `EXTRAS`.

    Args:
        extra: the extra.
        package: what is missing of it, by its module; that of the table when left out.
    """
    package = package or EXTRAS[extra]
    newest = _newest_python(package)
    if newest and newest <= _VERSION:
        return phrase(
            "there is no wheel of {package} for Python {version}: use an older Python, or run {command},"
            " which needs a compiler",
            package=package,
            version=".".join(map(str, _VERSION)),
            command=_installation().command_for_packages(package),
        )
    installation = _installation()
    command = installation.command_for_extras(extra)
    if installation.origin.is_gone:
        return phrase(
            "run {command}, with the path of a checkout or a wheel of Linkwright in place of {placeholder}: "
            "'{path}', which it was installed from, no longer exists",
            command=command,
            placeholder=installation.origin.words(())[-1],
            path=installation.origin.place,
        )
    return phrase("run {command}", command=command)


def package_hint(distribution: str) -> Phrase:
    """How to install a package that belongs to no extra, where Linkwright's Python finds it."""
    return phrase("run {command}", command=_installation().command_for_packages(distribution))


def _installation() -> Installation:
    from linkwright.diagnostics.installation import find_installation  # takes 15 ms, and is needed for errors alone

    return find_installation()


def _newest_python(package: str) -> tuple[int, ...]:
    """Return the first Python version for which no extra requires a package, as it has no wheel; empty for none."""
    from importlib.metadata import PackageNotFoundError, requires  # takes 10 ms, and is needed for errors alone

    try:
        asked = requires("linkwright") or []
    except PackageNotFoundError:  # it runs out of a folder
        return ()
    found = [line for line in asked if re.match(rf"{re.escape(package)}\b", line)]
    ends = [tuple(map(int, end.groups())) for line in found if (end := re.search(_BEFORE, line.replace('"', "'")))]
    return max(ends, default=()) if len(ends) == len(found) else ()


def missing_extra(code: str, error: ModuleNotFoundError) -> LinkwrightError:
    """Return the error about a missing extra.

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
    return LinkwrightError(Diagnostic(code, message, hint=install_hint(_BY_MODULE[package], package)))
