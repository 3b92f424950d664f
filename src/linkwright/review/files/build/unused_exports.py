"""Find exports of a build file that give nothing to other packages."""

from __future__ import annotations

from pathlib import PurePosixPath

from linkwright.packages.readers.package_xml import CATKIN
from linkwright.review.files.build.facts import UNSHARED_PACKAGES, BuildFacts, Fact, FactKind
from linkwright.review.versions import Version

_HEADER_SUFFIXES = (".h", ".hh", ".hpp", ".hxx", ".ipp", ".tpp", ".inl", ".cuh")
_INTERFACE_TOOLS = frozenset({"message_generation", "message_runtime", "rosidl_default_runtime"})
"""The packages that only the generated code of interfaces needs."""
_CATKIN = "catkin_package"


def is_unused_export(version: Version, path: str, old: BuildFacts, new: BuildFacts, fact: Fact) -> bool:
    """Return whether no other package can have used an exported folder or dependency of the old version.

    Args:
        version: the old version.
        path: the path of the build file in it.
        old: its facts.
        new: the facts of the new version.
        fact: the export that only the old version has.
    """
    if fact.kind is FactKind.EXPORTED_FOLDER:
        return _has_no_headers(version, path, old, fact.name)
    if fact.kind is FactKind.EXPORTED_DEPENDENCY:
        is_tool = fact.name in _INTERFACE_TOOLS and all(other.kind is not FactKind.INTERFACE for other in new.facts)
        return is_tool or fact.name in UNSHARED_PACKAGES or _uses_catkin(old) != _uses_catkin(new)
    return False


def _uses_catkin(facts: BuildFacts) -> bool:
    """Return whether a package is built for ROS 1, so that no package of ROS 2 has used its dependencies."""
    return any(fact.kind is FactKind.PACKAGE and fact.name == CATKIN for fact in facts.facts)


def _has_no_headers(version: Version, path: str, facts: BuildFacts, folder: str) -> bool:
    """Return whether an exported folder has no headers.

    A package of catkin exports a folder of its sources, and one of ament a folder below the prefix of installation.
    """
    if "$" in folder or PurePosixPath(folder).is_absolute():
        return False
    if _CATKIN in version.text(path):
        return not any(True for _ in version.paths(_HEADER_SUFFIXES, f"{facts.package}/{folder}".lstrip("/")))
    targets = map(PurePosixPath, facts.files)
    return facts.is_complete and not any(target.is_relative_to(folder) for target in targets)
