"""Find sources that no program of a package builds together."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import PurePosixPath

from linkwright.review.caching import cached_in_review
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.files.build.facts import BuildFacts, FactKind
from linkwright.review.installed_paths import read_package_facts
from linkwright.review.sources.unbuilt_sources import is_unbuilt
from linkwright.review.versions import Version

_INSTALLED_TARGETS = re.compile(
    r"^[ \t]*(?i:install)\s*\(\s*TARGETS\s+([^)]*?)\s(?:DESTINATION|RUNTIME|LIBRARY|ARCHIVE|EXPORT|INCLUDES)\b",
    re.MULTILINE,
)
"""The names in a command that installs targets, up to the first keyword."""
_RVIZ_CLASS = re.compile(r"EXPORT_CLASS\s*\([^;)]*\brviz(?:_common)?::\w+\s*\)")
"""The export of a class that RViz loads, and no node of the package."""


def are_in_separate_programs(version: Version, package: str, path: str, others: Iterable[str]) -> bool:
    """Return whether the build file builds a source only into programs that contain none of other sources.

    A plugin of RViz is in none of the programs.

    Args:
        version: the version of the repository.
        package: the folder of the package.
        path: the path of the source.
        others: the paths of the other sources.
    """
    programs = _find_programs(version, package)
    own = programs.get(path, frozenset())
    return bool(own) and all(
        own.isdisjoint(programs[other]) if other in programs else _RVIZ_CLASS.search(version.text(other)) is not None
        for other in others
    )


def find_programs(version: Version, package: str, path: str) -> tuple[frozenset[str], frozenset[str]]:
    """Return the programs of a package that contain a source, and the others, as the build file tells."""
    programs = _find_programs(version, package)
    own = programs.get(path, frozenset())
    return own, frozenset().union(*programs.values()) - own


@cached_in_review(maxsize=256)
def is_in_no_installed_program(version: Version, package: str | None, path: str) -> bool:
    """Return whether no target builds a source, or only programs that its package of ament does not install.

    No launch file or user starts such a program by its package.

    Args:
        version: the version of the repository.
        package: the folder of the package; None for a file outside of packages.
        path: the path of the source.
    """
    if package is None or not PurePosixPath(path).is_relative_to(package):
        return False
    if is_unbuilt(version, package, path):
        return True
    facts = read_package_facts(version, package)
    if facts is None or facts.routines:
        return False
    installed = _INSTALLED_TARGETS.findall(version.text(f"{package}/{CMAKE_FILE}".lstrip("/")))
    if not installed or any("$" in names for names in installed):
        return False
    source = PurePosixPath(path).relative_to(package).as_posix()
    targets = {name for name, parts in facts.targets.items() if source in parts.sources}
    used = {fact.name for fact in facts.facts if fact.kind in (FactKind.EXECUTABLE, FactKind.LIBRARY)}
    used |= {name for parts in facts.targets.values() for name in parts.libraries}
    built = {fact.name for fact in facts.facts if fact.kind is FactKind.BUILT_TARGET}
    return bool(targets) and targets <= built - used


@cached_in_review(maxsize=16)
def _find_programs(version: Version, package: str) -> dict[str, frozenset[str]]:
    """Return the programs that each source of a package is built into, also through libraries, by path."""
    facts = read_package_facts(version, package)
    if facts is None:
        return {}
    kinds = (FactKind.EXECUTABLE, FactKind.BUILT_EXECUTABLE)
    programs = {fact.name for fact in facts.facts if fact.kind in kinds}
    found: dict[str, set[str]] = {}
    for program in programs & facts.targets.keys():
        for target in _find_linked_targets(facts, program):
            for source in facts.targets[target].sources:
                found.setdefault((PurePosixPath(package) / source).as_posix(), set()).add(program)
    return {path: frozenset(names) for path, names in found.items()}


def _find_linked_targets(facts: BuildFacts, program: str) -> set[str]:
    """Return a target with the targets of the package that are linked to it."""
    linked: set[str] = set()
    remaining = [program]
    while remaining:
        name = remaining.pop()
        if name not in linked:
            linked.add(name)
            remaining += facts.targets.keys() & facts.targets[name].libraries.keys()
    return linked
