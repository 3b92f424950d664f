"""The extras of the distribution, which are optional libraries.

Commands name an extra if it is not installed.
"""

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
_BEFORE = r"python_version < '(\d+)\.(\d+)'"  # compiled only on use, because few commands need it


def install_hint(extra: str, package: str = "") -> Phrase:
    """Return a hint on how to install an extra of `EXTRAS`.

    Args:
        extra: the name of the extra.
        package: the missing module of the extra; by default its module in the table.
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
            "run {command}, and replace {placeholder} with the path of a checkout or wheel of "
            "Linkwright: '{path}', from which it was installed, no longer exists",
            command=command,
            placeholder=installation.origin.words(())[-1],
            path=installation.origin.place,
        )
    return phrase("run {command}", command=command)


def package_hint(distribution: str) -> Phrase:
    """Return a hint on how to install a package that belongs to no extra.

    The command installs it where Linkwright's Python finds it.
    """
    return phrase("run {command}", command=_installation().command_for_packages(distribution))


def _installation() -> Installation:
    from linkwright.diagnostics.installation import find_installation  # takes 15 ms, needed only for errors

    return find_installation()


def _newest_python(package: str) -> tuple[int, ...]:
    """Return the first Python version for which a package has no wheel, else empty.

    It is the version from which no extra requires the package.
    """
    from importlib.metadata import PackageNotFoundError, requires  # takes 10 ms, needed only for errors

    try:
        asked = requires("linkwright") or []
    except PackageNotFoundError:  # Linkwright runs from a folder without being installed
        return ()
    found = [line for line in asked if re.match(rf"{re.escape(package)}\b", line)]
    ends = [tuple(map(int, end.groups())) for line in found if (end := re.search(_BEFORE, line.replace('"', "'")))]
    return max(ends, default=()) if len(ends) == len(found) else ()


def missing_extra(code: str, error: ModuleNotFoundError) -> LinkwrightError:
    """Return the error for a library that cannot be imported because an extra is missing.

    Args:
        code: the code of the finding.
        error: the exception that the import of the library raised.

    Raises:
        ModuleNotFoundError: `error` itself, if the module belongs to no extra.
    """
    package = (error.name or "").partition(".")[0]
    if package not in _BY_MODULE:
        raise error
    message = phrase("the package '{package}' is not installed", package=package)
    return LinkwrightError(Diagnostic(code, message, hint=install_hint(_BY_MODULE[package], package)))
