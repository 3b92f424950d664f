"""Record the includes between descriptions, and the arguments and macros that they declare."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from linkwright.lint.inclusions import folders_by_package
from linkwright.lint.targets import DESCRIPTION_SUFFIXES, find_files_and_packages
from linkwright.review.parts.outline import MacroOutline, Outline, try_read_outline
from linkwright.review.versions import Version
from linkwright.xmltree import Element


class IncludeGraph:
    """The includes between the descriptions of a version.

    Args:
        version: the version of the repository.
    """

    def __init__(self, version: Version) -> None:
        self._version = version

    def declares(self, path: str, is_declared: Callable[[Outline], bool]) -> bool:
        """Return whether a file, or a file that it includes, fulfills a condition."""
        return any(is_declared(self._outlines[reachable]) for reachable in self._find_reachable(path, self._included))

    def find_robots_with(self, path: str) -> list[str]:
        """Return the top-level files that include a file, directly or indirectly."""
        return [
            reachable for reachable in self._find_reachable(path, self._includers) if not self._includers[reachable]
        ]

    def find_outlines_of_robots(self, path: str) -> list[Outline] | None:
        """Return the outlines of all files of the top-level files that include a file.

        The result is None if one of them may include a file that is not in the repository.
        """
        robots = self.find_robots_with(path)
        if any(self.find_unknown_includes(robot) for robot in robots):
            return None
        paths = {reachable for robot in robots for reachable in self._find_reachable(robot, self._included)}
        return [self._outlines[reachable] for reachable in sorted(paths)]

    def find_defaults(self, path: str) -> dict[str, str]:
        """Return the arguments with their defaults that all top-level files which include a file declare alike."""
        declared = [self._find_declared_defaults(robot) for robot in self.find_robots_with(path) or [path]]
        return {
            name: default
            for name, default in declared[0].items()
            if default is not None and all(defaults.get(name) == default for defaults in declared)
        }

    def _find_declared_defaults(self, robot: str) -> dict[str, str | None]:
        """Return the arguments of a file and its includes with their defaults; None if there are several or none."""
        defaults: dict[str, str | None] = {}
        for path in self._find_reachable(robot, self._included):
            for name, element in self._outlines[path].arguments.items():
                default = element.attributes.get("default")
                defaults[name] = default if defaults.get(name, default) == default else None
        return defaults

    def find_unknown_includes(self, path: str) -> set[str]:
        """Return the names of the files that a file may include, directly or indirectly, without those here."""
        return {
            inclusion.name
            for reachable in self._find_reachable(path, self._included)
            for inclusion in self._outlines[reachable].inclusions
            if not inclusion.pattern and inclusion.name not in self._names
        }

    def find_files_with_macro(self, macro: str) -> list[str]:
        """Return the files that define a macro."""
        return [path for path, outline in self._outlines.items() if macro in outline.macros]

    def find_macro_outlines(self, macro: str) -> list[MacroOutline]:
        """Return the definitions of a macro in all files."""
        return [self._outlines[path].macros[macro] for path in self.find_files_with_macro(macro)]

    def find_calls(self, macro: str) -> list[Element]:
        """Return the calls of a macro in all files."""
        tag = f"xacro:{macro}"
        return [element for outline in self._outlines.values() for element in outline.root.walk() if element.tag == tag]

    def find_call_places(self, macro: str) -> Iterator[tuple[str, Element]]:
        """Yield the calls of a macro in all files with their paths, also those in the namespace of an include.

        In packages of ROS 1, these are also the calls without a prefix in files that do not declare it, because xacro
        expands them where a robot includes the file. If several files define the macro, none are found.
        """
        if len(self.find_files_with_macro(macro)) != 1:
            return
        has_plain_calls = self._version.overlay is not None and macro in self._version.macros
        for path, outline in self._outlines.items():
            for element in outline.root.walk():
                name = element.tag.removeprefix("xacro:")
                if name.rpartition(".")[2] == macro and (name != element.tag or has_plain_calls):
                    yield path, element

    def find_macros(self, path: str) -> Collection[str]:
        """Return the names of the macros that a file defines."""
        outline = self._outlines.get(path)
        return () if outline is None else outline.macros

    def is_included(self, path: str) -> bool:
        """Return whether a description may include a file, whose suffix can be any."""
        file = self._version.file(path)
        inclusions = (inclusion for outline in self._outlines.values() for inclusion in outline.inclusions)
        return any(inclusion.name == file.name or inclusion.may_compute(file) for inclusion in inclusions)

    def iterate_outlines(self) -> Iterable[tuple[str, Outline]]:
        """Return the paths and outlines of the descriptions that can be read."""
        return self._outlines.items()

    def _find_reachable(self, path: str, edges: dict[str, set[str]]) -> Iterator[str]:
        pending, visited = [path], {path}
        while pending:
            current = pending.pop()
            if current not in self._outlines:
                continue
            yield current
            pending += sorted(edges[current] - visited)
            visited |= edges[current]

    @cached_property
    def _description_files(self) -> tuple[list[Path], list[Path]]:
        return find_files_and_packages(self._version.root, DESCRIPTION_SUFFIXES, self._version.entered)

    @cached_property
    def _outlines(self) -> dict[str, Outline]:
        """The outlines of the descriptions that can be read, by path."""
        outlines: dict[str, Outline] = {}
        for file in self._description_files[0]:
            outline, path = try_read_outline(file, self._version.overlay), self._version.relative(file)
            if outline is not None and path is not None:
                outlines[path] = outline
        return outlines

    @cached_property
    def _names(self) -> set[str]:
        """The names of the descriptions that can be read."""
        return {Path(path).name for path in self._outlines}

    @cached_property
    def _included(self) -> dict[str, set[str]]:
        """The files that each file can include."""
        packages = folders_by_package(self._description_files[1])
        by_name: dict[str, list[str]] = {}
        for path in self._outlines:
            by_name.setdefault(Path(path).name, []).append(path)
        included: dict[str, set[str]] = {}
        for path, outline in self._outlines.items():
            file = self._version.file(path)
            included[path] = {
                other
                for inclusion in outline.inclusions
                for other in (self._outlines if inclusion.pattern else by_name.get(inclusion.name, ()))
                if inclusion.may_lead(file, self._version.file(other), packages)
                or inclusion.may_compute(self._version.file(other))
            } - {path}
        return included

    @cached_property
    def _includers(self) -> dict[str, set[str]]:
        """The files that can include each file."""
        includers: dict[str, set[str]] = {path: set() for path in self._outlines}
        for path, included in self._included.items():
            for other in included:
                includers[other].add(path)
        return includers


@dataclass(frozen=True)
class IncludeGraphs:
    """The includes of both versions.

    Attributes:
        old: the includes of the old version.
        new: the includes of the new version.
    """

    old: IncludeGraph
    new: IncludeGraph
