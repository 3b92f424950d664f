"""Executables of installed packages."""

from __future__ import annotations

import os
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, did_you_mean, display_path
from linkwright.launch.engine.hosted_plan import hosted_executables
from linkwright.workspace import PackageFinder, PackageNotFoundError, install_prefix, is_installed


def find_executable(finder: PackageFinder, package: str, executable: str) -> Path:
    """The path of an executable: ``<prefix>/lib/PACKAGE/EXECUTABLE``, where ROS packages install them.

    Raises:
        LinkwrightError: LAUNCH131, with what was looked for and the nearest names.
    """
    ours: dict[str, list[str]] = {}
    for owner, name in hosted_executables():
        ours.setdefault(owner, []).append(name)
    try:
        share = finder.share(package)
    except PackageNotFoundError as error:
        notes = error.diagnostics[0].notes
        if package in ours:
            message = f"package '{package}' has no executable '{executable}' that runs without ROS"
            advice = did_you_mean(executable, ours[package]) or "there is " + ", ".join(ours[package])
            raise LinkwrightError(Diagnostic("LAUNCH131", message, notes=notes, hint=advice)) from error
        hint = did_you_mean(package, (*ours, *finder.packages())) or error.diagnostics[0].hint
        message = f"package '{package}' of node executable '{executable}' not found"
        raise LinkwrightError(Diagnostic("LAUNCH131", message, notes=notes, hint=hint)) from error
    folder = install_prefix(share) / "lib" / package
    path = folder / executable
    if path.is_file() and os.access(path, os.X_OK):
        return path
    message = f"package '{package}' has no executable '{executable}'"
    notes = (Note(f"looked for {display_path(path)}"),)
    present = [each.name for each in folder.iterdir() if os.access(each, os.X_OK)] if folder.is_dir() else []
    near = did_you_mean(executable, (*present, *ours.get(package, ())))
    if near is None and not is_installed(share):
        near = "the package is found in its sources only: build it with 'colcon build' and source install/setup.bash"
    elif near is None and present:
        near = "it has: " + ", ".join(sorted(present))
    elif near is None:
        near = (
            "it installs no executables: check entry_points in its setup.py, or install(TARGETS ...) in CMakeLists.txt"
        )
    raise LinkwrightError(Diagnostic("LAUNCH131", message, notes=notes, hint=near))
