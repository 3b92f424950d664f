"""Find build files that the build type of their package does not use."""

from __future__ import annotations

from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError
from linkwright.packages.manifest import MANIFEST
from linkwright.review.files.cmake_files import CMAKE_FILE
from linkwright.review.versions import Version
from linkwright.xacro.cache import read_document

_PYTHON_TYPE = "ament_python"
_TYPE_TAG = "build_type"


def is_unused_cmake_file(version: Version, path: str) -> bool:
    """Return whether a ``CMakeLists.txt`` belongs to a package that is built without CMake.

    Colcon builds a package of the type ``ament_python`` by its ``setup.py`` alone.

    Args:
        version: the version that contains the file.
        path: the path of the file relative to the root.
    """
    folder = version.package_of(path) if PurePosixPath(path).name == CMAKE_FILE else None
    if folder is None:
        return False
    try:
        export = read_document(str(version.file(folder) / MANIFEST)).root.first("export")
    except (LinkwrightError, OSError):
        return False
    types = [] if export is None else [element.text().strip() for element in export.elements(_TYPE_TAG)]
    return types == [_PYTHON_TYPE]
