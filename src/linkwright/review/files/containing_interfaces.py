"""Find the messages, services and actions that contain a changed message."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import PurePosixPath

from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST, package_name
from linkwright.review.caching import cached_in_review
from linkwright.review.versions import Version

_SUFFIXES = (".msg", ".srv", ".action")
_FIELD = re.compile(
    r"^[ \t]*(?:(?P<package>\w+)/(?:msg/)?)?(?P<type>[A-Z]\w*)(?:\[[^\]\n]*\])?[ \t]+[a-z]\w*", re.MULTILINE
)


def find_containing_interfaces(version: Version, path: str) -> list[str]:
    """Return the paths of the interfaces that contain a message, directly or in another message.

    Args:
        version: the version of the repository.
        path: the path of the message relative to the root.
    """
    if not path.endswith(".msg"):
        return []
    types = _read_types(version)
    found: dict[str, None] = {}
    pending = [path]
    while pending:
        name = _name_type(version, pending.pop())
        users = [user for user, names in types.items() if name in names and user not in found and user != path]
        found.update(dict.fromkeys(users))
        pending += [user for user in users if user.endswith(".msg")]
    return sorted(found)


@cached_in_review(maxsize=8)
def _read_types(version: Version) -> dict[str, frozenset[tuple[str, str]]]:
    """Return the packages and names of the types of fields that are messages, by the path of the interface."""
    return {path: frozenset(_find_types(version, path)) for path in version.paths(_SUFFIXES)}


def _find_types(version: Version, path: str) -> Iterator[tuple[str, str]]:
    own_package = _name_type(version, path)[0]
    for match in _FIELD.finditer(version.text(path)):
        yield match["package"] or own_package, match["type"]


def _name_type(version: Version, path: str) -> tuple[str, str]:
    """Return the package and the name of a type; the package is empty if it is unknown."""
    folder = version.package_of(path, (MANIFEST, ROSBUILD_MANIFEST))
    name = None if folder is None else package_name(version.file(folder)) or PurePosixPath(folder).name
    return name or "", PurePosixPath(path).stem
