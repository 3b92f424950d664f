"""Decide which changed files are sources whose names are compared."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.files.git_repository import ChangedFile
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.manifest import MANIFEST
from linkwright.review.sources.names import CPP_SUFFIXES, DYNAMIC_SUFFIX
from linkwright.review.sources.reading import is_program_text
from linkwright.review.versions import TEST_FOLDERS, Versions

_C_SUFFIX = ".c"
_GENERATED = re.compile(
    r"auto(?:matically)?[- ]?generated|\bgenerated (?:by|with|from|using)\b|do not edit", re.IGNORECASE
)
_MAX_HEAD_CHARACTERS = 2000
_SKIPPED_FILES = frozenset({"setup.py", "conf.py"})
_PYTHON_TEST = re.compile(
    r"^\s*(?:import|from)\s+(?:unittest|pytest|nose|rostest|launch_testing)\b|^\s*def test_", re.MULTILINE
)


def is_compared_source(versions: Versions, file: ChangedFile) -> bool:
    """Return whether a changed file is a program or header, and neither a test nor a launch file."""
    path = PurePosixPath(file.path)
    if path.name in _SKIPPED_FILES or path.name.startswith(".") or file.is_submodule:
        return False
    if not TEST_FOLDERS.isdisjoint(path.parts) or is_launch_file_name(path.name):
        return False
    version = versions.new if file.new_path else versions.old
    if path.suffix == _C_SUFFIX and (None in (file.old_path, file.new_path) or _is_generated(version.text(file.path))):
        return False  # most are libraries of others, and a node in C++ uses them
    if path.suffix == DYNAMIC_SUFFIX and not _is_of_ros1(versions, file):
        return False
    is_test = path.name.startswith("test_") and _has_tests(version.text(file.path), is_cpp=path.suffix in CPP_SUFFIXES)
    return not is_test and is_program_text(version.file(file.path))


def _is_of_ros1(versions: Versions, file: ChangedFile) -> bool:
    """Return whether a description of dynamic_reconfigure may be in a package of ROS 1, in one of both versions."""
    for version, path in ((versions.old, file.old_path), (versions.new, file.new_path)):
        package = None if path is None else version.package_of(path)
        manifest = "" if package is None else version.text((PurePosixPath(package) / MANIFEST).as_posix())
        if path is not None and ("ament" not in manifest or "catkin" in manifest):
            return True
    return False


def _is_generated(text: str) -> bool:
    """Return whether the first lines of a source say that a program wrote it."""
    return _GENERATED.search(text, 0, _MAX_HEAD_CHARACTERS) is not None


def _has_tests(text: str, *, is_cpp: bool) -> bool:
    """Return whether a source has tests, and is not only a program whose name begins with ``test_``."""
    if is_cpp:
        return "gtest" in text
    return not text.startswith("#!") or _PYTHON_TEST.search(text) is not None
