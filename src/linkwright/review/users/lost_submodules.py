"""Find out whether a repository still uses the package of a removed submodule."""

from __future__ import annotations

import re

from linkwright.packages.manifest import MANIFEST
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.versions import Versions

_BUILD_FILES = (MANIFEST, "CMakeLists.txt")
_USERS = (*_BUILD_FILES, *CPP_SUFFIXES, PYTHON_SUFFIX, ".launch", ".xml", ".yaml", ".yml", ".xacro", ".urdf", ".sh")


def is_no_longer_used(versions: Versions, name: str) -> bool:
    """Return whether the new version no longer names a package that manifests or build files of the old one named.

    The name of the folder of a submodule may not be that of a package. Then the old version does not name it either,
    and the result is False.
    """
    word = re.compile(rf"(?<![\w/-]){re.escape(name)}(?![\w-])")
    sides = ((versions.old, _BUILD_FILES), (versions.new, _USERS))
    was_used, is_used = (
        any(word.search(version.text(path)) for path in version.paths(suffixes)) for version, suffixes in sides
    )
    return was_used and not is_used
