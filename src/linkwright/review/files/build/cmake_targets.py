"""Compare the linked libraries and the sources of the targets of a ``CMakeLists.txt``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.packages.readers.cmake_language import Argument, Command, to_package_path
from linkwright.packages.readers.cmake_syntax import is_open
from linkwright.review.file_pair import FilePair
from linkwright.review.files.build.facts import (
    BuildFacts,
    TargetParts,
    find_new_source,
    find_renamed_targets,
    list_names,
)

_SOURCE_COMMANDS = frozenset(
    {
        *("add_executable", "add_library", "ament_auto_add_executable", "ament_auto_add_library", "target_sources"),
        *("rosbuild_add_executable", "rosbuild_add_library", "cuda_add_executable", "cuda_add_library"),
    }
)
_PYTEST_COMMAND = "ament_add_pytest_test"
_TEST_PROGRAM_COMMAND = re.compile(r"(\w+_)?add_(\w*_)?(gtest|gmock|gbenchmark|google_benchmark|catch2)(_executable)?")
"""A command that builds the program of a test, such as ``add_rostest_gtest``."""
_TEST_SOURCE = re.compile(r".+\.(c|cc|cpp|cxx|cu|py)")
"""A source among the arguments of a test, which also has a launch file, a timeout and an environment."""
_LINK_COMMANDS = frozenset({"target_link_libraries", "ament_target_dependencies", "rosbuild_link_boost"})
_LINK_KEYWORDS = frozenset(
    {
        *("PUBLIC", "PRIVATE", "INTERFACE", "SYSTEM", "LINK_PUBLIC", "LINK_PRIVATE", "LINK_INTERFACE_LIBRARIES"),
        *("LINK_INTERFACE_MULTIPLICITY", "OVERRIDE_INTERFACE"),
    }
)
_LOADED = re.compile(
    r"\b[A-Z]\w*(?:REGISTER|EXPORT|DECLARE)\w*\s*\(|\b[A-Z]\w*_MODULE\w*\s*\(|\bextern\s+\"C\"|\bPyInit_"
)
"""A class or function that programs load from a library at run time."""
_VARIABLE = re.compile(r"\$\{(\w+?)_(LIBRARIES|LIBRARY|TARGETS|LIBS)\}", re.IGNORECASE)


def read_targets(commands: Iterable[Command]) -> dict[str, TargetParts]:
    """Return the parts of targets, by target.

    Packages and their targets count as the same library.
    """
    targets: dict[str, TargetParts] = {}
    for command in commands:
        is_test_program = builds_test(command.name)
        is_test = is_test_program or command.name == _PYTEST_COMMAND
        is_read = is_test or command.name in _SOURCE_COMMANDS | _LINK_COMMANDS
        if not is_read or not command.arguments:
            continue
        target, *arguments = command.arguments
        parts = targets.setdefault(target.text, TargetParts())
        parts.is_test |= is_test
        parts.is_test_program |= is_test_program
        for argument in arguments:
            is_link = command.name in _LINK_COMMANDS
            is_library = is_link and _is_library(argument.text)
            if (argument.text.isupper() and not is_library) or not re.search(r"\w", argument.text):
                continue  # a keyword, such as PUBLIC, or an unknown variable
            if is_link:
                parts.libraries.setdefault(_get_library_name(argument.text, command.name), _get_span(argument))
            elif not is_open(argument.text) and (not is_test or _TEST_SOURCE.fullmatch(argument.text)):
                parts.sources.setdefault(to_package_path(argument.text, command.folder), _get_span(argument))
    return targets


def _is_library(text: str) -> bool:
    """Return whether a word in capital letters is a library, such as ``PCL`` and ``${PCL_LIBRARIES}``."""
    return _VARIABLE.fullmatch(text) is not None or (text not in _LINK_KEYWORDS and not is_open(text))


def has_unknown_sources(commands: Iterable[Command]) -> bool:
    """Return whether a target may have sources that are not known, such as those of an unknown variable."""
    return any(
        is_open(argument.text)
        for command in commands
        if command.name in _SOURCE_COMMANDS or builds_test(command.name)
        for argument in command.arguments
    )


def find_private_libraries(
    commands: Sequence[Command], targets: Mapping[str, TargetParts], folder: Path
) -> Iterator[str]:
    """Yield the libraries that only targets of their package of catkin use.

    The package does not export them, and their sources neither register plugins nor have functions that programs load
    by name. Libraries whose sources are not known are left out.

    Args:
        commands: the commands of the build file.
        targets: the parts of targets, by target.
        folder: the folder of the package.
    """
    exports = [command.words for command in commands if command.name == "catkin_package"]
    if not exports or any(is_open(word) for words in exports for word in words):
        return
    exported = {word for words in exports for word in words}
    for name, parts in targets.items():
        sources = [folder / source for source in parts.sources]
        is_known = bool(sources) and name not in exported and all(file.is_file() for file in sources)
        if is_known and not any(_LOADED.search(file.read_text("utf-8", errors="replace")) for file in sources):
            yield name


def builds_test(command: str) -> bool:
    """Return whether a command builds the program of a test."""
    return _TEST_PROGRAM_COMMAND.fullmatch(command) is not None


def _get_library_name(text: str, command: str) -> str:
    """Return the name of a library, or of its package if it has the name of the package or is in a variable of it."""
    variable = _VARIABLE.fullmatch(text)
    if variable is not None:
        return variable[1]
    if command == "rosbuild_link_boost":
        return f"boost_{text}"
    package, _, library = text.partition("::")
    return package if library == package else text


def _get_span(argument: Argument) -> Span:
    return argument.source.span(argument.start, argument.end)


def compare_targets(pair: FilePair, old: BuildFacts, new: BuildFacts) -> None:
    """Report the changed libraries and sources of targets.

    Equal changes to several targets share a line. A library with a new name, such as that of the package, is the same.
    """
    changes: dict[_TargetChange, list[tuple[str, Span]]] = {}
    renamed = {**find_renamed_targets(pair.versions, old, new), old.project: new.project}
    for name, parts in new.targets.items():
        before = old.targets.get(name)
        if before is None:
            continue
        libraries = {renamed.get(item, item): span for item, span in before.libraries.items()}
        sources = {find_new_source(pair.versions, old, new, item): span for item, span in before.sources.items()}
        if parts.is_test:
            _report_moved_sources(pair, name, dict(zip(before.sources, sources, strict=False)), parts.sources)
        for kind, old_items, new_items in (
            ("libraries", libraries, parts.libraries),
            ("sources", sources, parts.sources if sources else {}),
        ):
            if kind == "sources" and not new_items:
                continue  # no longer built
            old_items, new_items = (
                {key: value for key, value in items.items() if key != name} for items in (old_items, new_items)
            )
            span = next(iter({**new_items, **old_items}.values()), None)
            for is_added, items in (
                (True, _find_unpaired_names(new_items, old_items)),
                (False, _find_unpaired_names(old_items, new_items)),
            ):
                if items and span is not None:
                    key = _TargetChange(kind, is_added, tuple(items))
                    changes.setdefault(key, []).append((name, new_items.get(items[0], span)))
    for name, parts in new.targets.items():
        span, before = parts.libraries.get(name), old.targets.get(name)
        if span is not None and before is not None and name not in before.libraries:
            pair.add(phrase("'{target}' linked to itself", target=name), pair.location(span))
    for key, targets in changes.items():
        text = _format_change(key.kind, [name for name, _ in targets], key.items, is_added=key.is_added)
        pair.add(text, pair.location(targets[0][1]))


def _report_moved_sources(pair: FilePair, test: str, moved: Mapping[str, str], sources: Mapping[str, Span]) -> None:
    """Report the moved sources of a test. No other line of a review names the sources of tests."""
    for old_path, path in moved.items():
        if old_path != path and path in sources:
            text = phrase("source of '{target}' moved: '{old}' -> '{new}'", target=test, old=old_path, new=path)
            pair.add(text, pair.location(sources[path]))


class _TargetChange(NamedTuple):
    """A change to targets: the kind of parts, and the names that only one version has."""

    kind: str
    is_added: bool
    items: tuple[str, ...]


def _find_unpaired_names(items: Mapping[str, Span], others: Mapping[str, Span]) -> list[str]:
    """Return the names that only one side has.

    A library of a package such as ``a::b``, and the package ``a`` on the other side, are a pair.
    """
    replaced = {item for item in others if item not in items}
    packages = {item.partition("::")[0] for item in replaced if "::" in item}
    unpaired = [item for item in items if item not in others and item not in packages]
    return [item for item in unpaired if "::" not in item or item.partition("::")[0] not in replaced]


def _format_change(kind: str, targets: Sequence[str], items: Sequence[str], *, is_added: bool) -> Phrase:
    names = {"targets": list_names(targets), "names": list_names(items)}
    if kind == "libraries":
        if is_added:
            return phrase("{targets} linked to {names}", **names)
        return phrase("{targets} no longer linked to {names}", **names)
    if is_added:
        return phrase("sources of {targets} added: {names}", **names)
    return phrase("sources of {targets} removed: {names}", **names)
