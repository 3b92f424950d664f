"""Tell whether a version needs a package for the first time although no ``package.xml`` names it."""

from __future__ import annotations

import re

from linkwright.lint.dependencies import is_covered, list_companion_prefixes
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.caching import cached_in_review
from linkwright.review.launch_paths import find_launch_files
from linkwright.review.versions import Version, Versions
from linkwright.xacro.cache import read_document

_SUFFIXES = (".yaml", ".yml", ".launch", ".xml", ".xacro", ".py", ".cpp", ".hpp", ".h", ".repos", ".rosinstall")
"""The ends of the names of files that may name a package."""
_COMMENT = re.compile(r"<!--.*?-->|^\s*(?:#(?!include\b)|//)[^\n]*", re.DOTALL | re.MULTILINE)
"""A comment in XML, or a line with only a comment."""
_STARTED_PACKAGE = re.compile(r"\b(?:pkg|package)\s*[=:]\s*[\"']?([a-z]\w+)")
"""The package of a node in a launch file."""


def is_undeclared_and_new(versions: Versions, path: str, package: str) -> bool:
    """Return whether no manifest of the new version brings a package, and no file of the old version names it.

    The result is False for a file of a package that only the new version has, because nothing depends on it yet. It is
    also False if the old version already starts programs that no manifest brings, of packages that are installed
    together with this one, such as those of Nav2.

    Args:
        versions: the repository before and after the change.
        path: the path of the file that needs the package, in the new version.
        package: the name of the package.
    """
    folder = versions.new.package_of(path)
    if folder is None or not (versions.old.file(folder) / MANIFEST).is_file():
        return False
    if is_declared(versions.new, package) or is_named(versions.old, package):
        return False
    prefixes = list_companion_prefixes(package)
    companions = {name for name in _list_started_packages(versions.old) if name.startswith(prefixes)}
    return not companions or any(is_declared(versions.new, name) for name in companions)


@cached_in_review(maxsize=8)
def _list_started_packages(version: Version) -> frozenset[str]:
    """Return the packages whose programs the launch files of a version start."""
    texts = (_COMMENT.sub("", version.text(path)) for path in find_launch_files(version))
    return frozenset(name for text in texts for name in _STARTED_PACKAGE.findall(text))


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
