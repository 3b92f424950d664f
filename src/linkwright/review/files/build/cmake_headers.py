"""Find the headers that a ``CMakeLists.txt`` gives to other packages without rules for files and folders."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import takewhile

from linkwright.packages.readers.cmake_language import Command, to_package_path
from linkwright.packages.readers.cmake_values import split_items

_FILE_SET = "FILE_SET"
_PUBLIC_HEADER = "PUBLIC_HEADER"
_INSTALL_INTERFACE = re.compile(r"\$<INSTALL_INTERFACE:(?P<folder>[^>$]+)>")
_AUTO_FOLDER = "include"
"""The folder that ``ament_auto_package`` installs."""


def find_header_paths(commands: Sequence[Command], exported_folders: Iterable[str]) -> Iterator[str]:
    """Yield the headers, and the folders of headers, that other packages find.

    They are relative to the package. Headers that ``install(DIRECTORY)`` and ``install(FILES)`` copy are left out.

    Args:
        commands: the commands of the build file.
        exported_folders: the folders of headers that the package exports. Packages of ament only refer to them, but
            catkin also finds them in the source folder.
    """
    names = {command.name for command in commands}
    if "catkin_package" in names:
        yield from exported_folders
    if "ament_auto_package" in names:
        yield _AUTO_FOLDER
    for command in commands:
        part, paths = _read_headers_of_target(command)
        if paths and _is_installed(commands, command.words[0], part):
            yield from (to_package_path(path, command.folder) for path in paths)


def find_include_folders(commands: Sequence[Command]) -> Iterator[str]:
    """Yield the folders below which other packages find installed headers, relative to the prefix.

    Args:
        commands: the commands of the build file.
    """
    for command in commands:
        words = command.words
        if command.name == "ament_export_include_directories":
            yield from (word.strip("/") for word in words if "$" not in word)
        elif command.name == "catkin_package":
            yield _AUTO_FOLDER
        elif command.name == "install" and "INCLUDES" in words:
            index = words.index("INCLUDES")
            yield from (word.strip("/") for word in takewhile(lambda text: not text.isupper(), words[index + 2 :]))
        elif command.name == "target_include_directories":
            matches = (_INSTALL_INTERFACE.search(word) for word in words)
            yield from (match["folder"].strip("/") for match in matches if match)


def _read_headers_of_target(command: Command) -> tuple[str, list[str]]:
    """Return the headers that a command gives to a target, after the keyword that installs them."""
    words = command.words
    if command.name == "target_sources" and _FILE_SET in words:
        return _FILE_SET, list(_list_set_files(words))
    if command.name == "set_target_properties" and _PUBLIC_HEADER in words[:-1]:
        return _PUBLIC_HEADER, split_items(words[words.index(_PUBLIC_HEADER) + 1])
    return "", []


def _is_installed(commands: Iterable[Command], target: str, part: str) -> bool:
    """Return whether a rule installs a part of a target, such as its sets of files."""
    return any(
        command.name == "install" and command.words[:1] == ["TARGETS"] and {target, part} <= set(command.words)
        for command in commands
    )


def _list_set_files(words: Sequence[str]) -> Iterator[str]:
    """Yield the files of the sets of files in the arguments of ``target_sources``."""
    for index, word in enumerate(words):
        if word == "FILES":
            yield from takewhile(lambda text: not text.isupper(), words[index + 1 :])
