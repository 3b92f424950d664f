"""The extras of the distribution: optional libraries.

If a command needs an extra that is missing, its error names the extra.
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
    "arm": "ompl",
    "bag": "rosbags",
    "colcon": "colcon_core",
    "dds": "cyclonedds",
    "diagram": "pygraphviz",
    "image": "PIL",
    "learn": "markdown_it",
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
"""The extras, each with a module that is missing without it."""

_EXTRA_BY_MODULE = {
    **{module: extra for extra, module in EXTRAS.items()},
    "cv2": "vision",
    "lsprotocol": "lsp",
    "winpty": "learn",
}


_PYTHON_VERSION = sys.version_info[:2]
_VERSION_LIMIT_PATTERN = r"python_version < '(\d+)\.(\d+)'"  # compiled only on use, because few commands need it


def install_hint(extra: str, package: str = "") -> Phrase:
    """Return a hint for installing an extra.

    Args:
        extra: the name of the extra, a key of `EXTRAS`.
        package: the missing module of the extra; empty for its module in `EXTRAS`.
    """
    package = package or EXTRAS[extra]
    first_unsupported = _find_first_python_without_wheel(package)
    if first_unsupported and first_unsupported <= _PYTHON_VERSION:
        return phrase(
            "there is no wheel of {package} for Python {version}: use an older Python, or run {command},"
            " which needs a compiler",
            package=package,
            version=".".join(map(str, _PYTHON_VERSION)),
            command=_load_installation().command_for_packages(package),
        )
    installation = _load_installation()
    command = installation.command_for_extras(extra)
    if installation.origin.is_missing:
        return phrase(
            "run {command}, and replace {placeholder} with the path of a checkout or wheel of Linkwright, "
            "because '{path}', from which it was installed, no longer exists",
            command=command,
            placeholder=installation.origin.installer_arguments(())[-1],
            path=installation.origin.location,
        )
    return phrase("run {command}", command=command)


def package_hint(distribution: str) -> Phrase:
    """Return a hint for installing a package that does not belong to an extra.

    The command installs the package into the environment of Linkwright's Python.
    """
    return phrase("run {command}", command=_load_installation().command_for_packages(distribution))


def _load_installation() -> Installation:
    from linkwright.diagnostics.installation import find_installation  # takes 15 ms, needed only for errors

    return find_installation()


def _find_first_python_without_wheel(package: str) -> tuple[int, ...]:
    """Return the first Python version for which a package has no wheel, or an empty tuple.

    From this version on, no extra requires the package.
    """
    from importlib.metadata import PackageNotFoundError, requires  # takes 10 ms, needed only for errors

    try:
        requirements = requires("linkwright") or []
    except PackageNotFoundError:  # Linkwright runs from a folder without being installed
        return ()
    package_requirements = [line for line in requirements if re.match(rf"{re.escape(package)}\b", line)]
    limits = [
        tuple(map(int, match.groups()))
        for line in package_requirements
        if (match := re.search(_VERSION_LIMIT_PATTERN, line.replace('"', "'")))
    ]
    return max(limits, default=()) if len(limits) == len(package_requirements) else ()


def missing_extra(code: str, error: ModuleNotFoundError) -> LinkwrightError:
    """Return the error for a library that cannot be imported because an extra is missing.

    Args:
        code: the code of the diagnostic.
        error: the exception that the import of the library raised.

    Raises:
        ModuleNotFoundError: `error` itself, if the module belongs to no extra.
    """
    package = (error.name or "").partition(".")[0]
    if package not in _EXTRA_BY_MODULE:
        raise error
    message = phrase("the package '{package}' is not installed", package=package)
    return LinkwrightError(Diagnostic(code, message, hint=install_hint(_EXTRA_BY_MODULE[package], package)))
