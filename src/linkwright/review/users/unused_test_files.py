"""Find renamed files of tests that nothing else uses."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.review.installed_paths import find_installed_paths
from linkwright.review.users.installed_readers import READER_SUFFIXES
from linkwright.review.versions import TEST_FOLDERS, Versions


def is_unused_test_file(versions: Versions, old_path: str, new_path: str) -> bool:
    """Return whether a renamed file belongs to tests, is not installed, and no file has its old name any more."""
    package = versions.old.package_of(old_path)
    if package is None or TEST_FOLDERS.isdisjoint(PurePosixPath(old_path).relative_to(package).parts):
        return False
    if (
        versions.new.package_of(new_path) != package
        or find_installed_paths(versions.old, package, old_path) != frozenset()
    ):
        return False
    name = re.compile(rf"(?<![\w.-]){re.escape(PurePosixPath(old_path).name)}(?![\w.-])")
    return not any(name.search(versions.new.text(path)) for path in versions.new.paths(READER_SUFFIXES))
