"""Tell whether a version needs a package for the first time although no ``package.xml`` names it."""

from __future__ import annotations

import re

from linkwright.lint.dependencies import is_covered
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.caching import cached_in_review
from linkwright.review.versions import Version, Versions
from linkwright.xacro.cache import read_document

_SUFFIXES = (".yaml", ".yml", ".launch", ".xml", ".xacro", ".py", ".cpp", ".hpp", ".h", ".repos", ".rosinstall")
"""The ends of the names of files that may name a package."""
_COMMENT = re.compile(r"<!--.*?-->|^\s*(?:#(?!include\b)|//)[^\n]*", re.DOTALL | re.MULTILINE)
"""A comment in XML, or a line with only a comment."""


def is_undeclared_and_new(versions: Versions, path: str, package: str) -> bool:
    """Return whether no manifest of the new version brings a package, and no file of the old version names it.

    The result is False for a file of a package that only the new version has, because nothing depends on it yet.

    Args:
        versions: the repository before and after the change.
        path: the path of the file that needs the package, in the new version.
        package: the name of the package.
    """
    folder = versions.new.package_of(path)
    if folder is None or not (versions.old.file(folder) / MANIFEST).is_file():
        return False
    return not is_declared(versions.new, package) and not is_named(versions.old, package)


@cached_in_review(maxsize=256)
def is_declared(version: Version, package: str) -> bool:
    """Return whether a package of a version is the package, or depends on it."""
    if package in version.shares:
        return True
    finder = version.finder(version.root)
    manifests = [Manifest(read_document(str(version.file(path)))) for path in version.paths((MANIFEST,))]
    return any(
        any("$" in dependency.name for dependency in manifest.dependencies) or is_covered(package, manifest, finder)
        for manifest in manifests
    )


@cached_in_review(maxsize=256)
def is_named(version: Version, package: str) -> bool:
    """Return whether a file of a version names a package outside of comments."""
    word = re.compile(rf"(?<!\w){re.escape(package)}(?!\w)")
    return any(word.search(_COMMENT.sub("", version.text(path))) for path in version.paths(_SUFFIXES))
