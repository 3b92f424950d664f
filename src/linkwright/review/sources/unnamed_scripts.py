"""Find Python scripts that no program can start by a name, because nothing installs or names them."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import PurePosixPath

from linkwright.review.files.setup_files import SETUP_FILE
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.versions import Version

_BUILD_FILE = "CMakeLists.txt"
_NAMING_SUFFIXES = (
    *(PYTHON_SUFFIX, ".cfg", ".toml", ".launch", ".xml", ".yaml", ".yml", ".sh", ".bash", ".bt", ".service", ".txt"),
    *(".md", ".rst", ".desktop", ".rules", "Dockerfile", "Makefile"),
)
"""The files that may start a script or tell users to do so."""
_SCRIPTS = re.compile(r"\bscripts\s*=")
"""The argument of ``setup()`` with files that become executable."""
_EXECUTABLE = 0o111


def is_unnamed_script(version: Version, package: str, path: str) -> bool:
    """Return whether a Python script of a package that ``setup.py`` builds is not executable, and no file names it.

    Args:
        version: the version that contains the script.
        package: the folder of its package.
        path: the path of the script.
    """
    folder = PurePosixPath(package)
    setup = version.text((folder / SETUP_FILE).as_posix())
    if not path.endswith(PYTHON_SUFFIX) or not setup or _SCRIPTS.search(setup):
        return False
    if version.file((folder / _BUILD_FILE).as_posix()).is_file() or version.file(path).stat().st_mode & _EXECUTABLE:
        return False
    return not _is_named(version, path)


@lru_cache(maxsize=64)
def _is_named(version: Version, path: str) -> bool:
    word = re.compile(rf"(?<![\w-]){re.escape(PurePosixPath(path).stem)}(?![\w-])")
    return any(word.search(version.text(other)) for other in version.paths(_NAMING_SUFFIXES) if other != path)
