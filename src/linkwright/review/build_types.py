"""Find build files that the build of their package does not use."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError
from linkwright.packages.manifest import MANIFEST
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.versions import Version
from linkwright.xacro.cache import read_document

_PYTHON_TYPE = "ament_python"
_TYPE_TAG = "build_type"
_SUBDIRECTORY = re.compile(
    r"(?:^[ \t]*\w*(?:subdirectory|subdirs)\w*\s*\(|\bSOURCE_DIR\b)\s*\"?([^\s\")]+)", re.IGNORECASE | re.MULTILINE
)
"""The folder that a command such as ``add_subdirectory`` names. A loop names it by a variable."""


def is_unused_cmake_file(version: Version, path: str) -> bool:
    """Return whether a ``CMakeLists.txt`` belongs to a package that is built without it.

    Colcon builds a package of the type ``ament_python`` by its ``setup.py`` alone, and CMake reads the file of a
    subdirectory only if another file of the package adds it.

    Args:
        version: the version that contains the file.
        path: the path of the file relative to the root.
    """
    folder = version.package_of(path) if PurePosixPath(path).name == CMAKE_FILE else None
    if folder is None:
        return False
    if PurePosixPath(path).parent != PurePosixPath(folder) and not _is_added(version, folder, path):
        return True
    try:
        export = read_document(str(version.file(folder) / MANIFEST)).root.first("export")
    except (LinkwrightError, OSError):
        return False
    types = [] if export is None else [element.text().strip() for element in export.elements(_TYPE_TAG)]
    return types == [_PYTHON_TYPE]


def _is_added(version: Version, package: str, path: str) -> bool:
    """Return whether a file of CMake in a package may add a subdirectory, or the package itself is not of CMake."""
    if not version.file(package).joinpath(CMAKE_FILE).is_file():
        return True
    folder = PurePosixPath(path).parent
    names = {folder.name, folder.relative_to(package).as_posix()}
    return any(
        argument.rstrip("/").rpartition("/")[2] in names or "$" in argument.rpartition("/")[2]
        for other in version.paths((CMAKE_FILE, ".cmake"), package)
        for argument in _SUBDIRECTORY.findall(version.text(other))
    )
