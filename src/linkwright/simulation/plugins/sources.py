"""The C++ sources of plugins, in the packages of the workspace."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.cmake_language import CMakeProgram, Command
from linkwright.sdf.plugins import library_name

_BUILD_FILE = "CMakeLists.txt"
_LIBRARY_COMMANDS = frozenset(
    (
        *("add_library", "ament_auto_add_library", "rosbuild_add_library", "cuda_add_library"),
        *("gz_add_system", "ign_add_system", "gz_build_plugin", "gazebo_plugin"),
    )
)
_SOURCE_SUFFIXES = (".cc", ".cpp", ".cxx", ".c++", ".cu")


@dataclass(frozen=True, slots=True)
class PluginSource:
    """The source of a library.

    Attributes:
        package: the package that builds the library.
        file: the first source file, or the build file if it names none.
    """

    package: str
    file: Path


def find_plugin_sources(libraries: set[str], packages: Mapping[str, Path]) -> dict[str, PluginSource]:
    """Return the sources of libraries.

    Args:
        libraries: the libraries, named as `library_name` returns them.
        packages: the folders of the packages by name.
    """
    sources: dict[str, PluginSource] = {}
    for package, folder in packages.items():
        if sources.keys() >= libraries:
            break
        for command in _iterate_commands(folder):
            words = command.words
            name = library_name(words[0]) if words else ""
            if command.name in _LIBRARY_COMMANDS and name in libraries and name not in sources:
                sources[name] = PluginSource(package, _find_source_file(folder / command.folder, words[1:]))
    return sources


def _iterate_commands(folder: Path) -> Iterator[Command]:
    """Yield the commands of the build file of a package that builds libraries."""
    path = folder / _BUILD_FILE
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return
    yield from CMakeProgram(folder).run(SourceText(str(path), text))


def _find_source_file(folder: Path, words: list[str]) -> Path:
    names = (word for word in words if word.endswith(_SOURCE_SUFFIXES))
    files = (folder / name for name in names if (folder / name).is_file())
    return next(files, folder / _BUILD_FILE)
