"""Reader for calls of xacro in ``CMakeLists.txt``.

The calls are macros of the package xacro, and commands that run the program.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.cmake_language import CMakeProgram, Command, to_package_path
from linkwright.packages.readers.xacro_calls.call import CallingFile, XacroCall
from linkwright.packages.readers.xacro_calls.command_line import parse_xacro_command
from linkwright.packages.readers.xacro_calls.texts import Text, join_texts, make_literal

_MACROS = frozenset({"xacro_add_xacro_file", "xacro_add_files"})
_RUN_COMMANDS = frozenset({"add_custom_command", "add_custom_target", "execute_process"})
_KEYWORDS = frozenset({"INORDER", "FORMAT", "REMAP", "INSTALL", "DESTINATION", "OUTPUT", "TARGET", "DEPENDS"})


def read_cmake_calls(source: SourceText, package: Path) -> CallingFile:
    """Read the calls of xacro in a ``CMakeLists.txt``.

    Args:
        source: the text of the file.
        package: the folder of the package.
    """
    file = CallingFile(source.name)
    for command in CMakeProgram(package).run(source):
        if command.name in _MACROS or command.name in _RUN_COMMANDS:
            for path, arguments in _find_calls(command, package):
                first = command.arguments[0]
                file.calls.append(XacroCall(path, arguments, first.source.span(first.start, first.end)))
    return file


def _find_calls(command: Command, package: Path) -> Iterator[tuple[Text, dict[str, Text]]]:
    if command.name in _MACROS:
        arguments: dict[str, Text] = {}
        files: list[str] = []
        keyword = ""
        for word in command.words:
            keyword = word if word in _KEYWORDS else keyword
            name, separator, value = word.partition(":=")
            if separator:
                arguments[name] = make_literal(value)
            elif not keyword:
                files.append(word)
        files = files[:1] if command.name == "xacro_add_xacro_file" else files
        for file in files:
            yield make_literal(_resolve_description(file, command, package)), arguments
        return
    words = command.words
    if "COMMAND" in words:
        line = words[words.index("COMMAND") + 1 :]
        call = parse_xacro_command(
            join_texts(make_literal(f"{_resolve_description(word, command, package)} ") for word in line)
        )
        if call is not None:
            yield call


def _resolve_description(word: str, command: Command, package: Path) -> str:
    """Return the path of the robot description that an argument names.

    Other arguments are returned unchanged.
    """
    if not word.endswith((".xacro", ".urdf")):
        return word
    return str(package / to_package_path(word, command.folder))
