"""Find files of tests, which nothing else uses, and other files without users."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.diagnostics import SourceText
from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST, package_name
from linkwright.review.caching import cached_in_review
from linkwright.review.files.build.cmake_branches import iterate_conditional_commands
from linkwright.review.installed_paths import find_installed_paths, find_targets
from linkwright.review.users.installed_readers import READER_SUFFIXES
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_TEST_CONDITION = re.compile(r"(?<!NOT )\b(?:BUILD_TESTING|CATKIN_ENABLE_TESTING)\b")
_USERS = (*READER_SUFFIXES, ".md", ".rst", "Dockerfile")
"""The ends of the names of files that may start a package, or tell users to do so."""


def is_test_file(version: Version, path: str) -> bool:
    """Return whether a file belongs to tests and is certainly not installed, or only if tests are built.

    Nothing installs a file without a package. A package in a folder of tests, which installs its files, must have no
    users outside of such folders.
    """
    package = version.package_of(path, (MANIFEST, ROSBUILD_MANIFEST))
    if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
        return False
    if package is None:
        return True
    if not TEST_FOLDERS.isdisjoint(PurePosixPath(package).parts[:-1]):
        return not _has_users_outside_of_tests(version, package)
    if TEST_FOLDERS.isdisjoint(PurePosixPath(path).relative_to(package).parts):
        return False
    relative_path = PurePosixPath(path).relative_to(package)
    return find_targets(version, package, path) == frozenset() or _is_installed_for_tests(
        version, package, relative_path
    )


@cached_in_review(maxsize=64)
def _has_users_outside_of_tests(version: Version, package: str) -> bool:
    """Return whether a file outside of the folders of tests has the name of a package."""
    folder = PurePosixPath(package)
    name = re.compile(rf"(?<![\w.-]){re.escape(package_name(version.file(package)) or folder.name)}(?![\w-])")
    readers = (path for path in version.paths(_USERS) if TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts))
    return any(name.search(version.text(reader)) for reader in readers)


def _is_installed_for_tests(version: Version, package: str, path: PurePosixPath) -> bool:
    """Return whether all commands of a package that install a file do so only if tests are built."""
    build_file = (PurePosixPath(package) / "CMakeLists.txt").as_posix()
    source = SourceText(build_file, version.text(build_file))
    names = {path.as_posix(), *(f"{parent}" for parent in path.parents if parent.name)}
    conditions = [
        condition
        for statement, condition in iterate_conditional_commands(source)
        if statement.name == "install" and any(token.text.rstrip("/") in names for token in statement.tokens)
    ]
    return bool(conditions) and all(_TEST_CONDITION.search(condition) for condition in conditions)


def is_unused_test_file(versions: Versions, old_path: str, new_path: str) -> bool:
    """Return whether a renamed file belongs to tests, is not installed, and no file has its old name any more."""
    if not is_test_file(versions.old, old_path):
        return False
    is_same_package = versions.new.package_of(new_path) == versions.old.package_of(old_path)
    return is_same_package and not _is_named(versions.new, old_path)


def is_unused_file(versions: Versions, old_path: str) -> bool:
    """Return whether a removed or renamed file was certainly not installed, and no file has its name any more."""
    package = versions.old.package_of(old_path)
    if package is None or find_installed_paths(versions.old, package, old_path) != frozenset():
        return False
    return not _is_named(versions.new, old_path)


def _is_named(version: Version, path: str) -> bool:
    name = re.compile(rf"(?<![\w.-]){re.escape(PurePosixPath(path).name)}(?![\w.-])")
    return any(name.search(version.text(reader)) for reader in version.paths(READER_SUFFIXES))
