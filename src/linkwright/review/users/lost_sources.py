"""Find build files and sources that name a source or header which was removed or renamed, so that the build fails."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.sources.cpp.preprocessor import blank_disabled
from linkwright.review.sources.names import CPP_SUFFIXES, HEADER_SUFFIXES
from linkwright.review.versions import TEST_FOLDERS, Versions

_COMMENT = re.compile(r"#[^\n]*")
_BUILD = re.compile(
    r"\b(?P<name>add_library|add_executable|target_sources|generate_parameter_library|generate_parameter_module|"
    r"rosidl_generate_interfaces|ament_add_gtest|ament_add_gmock|ament_add_pytest_test|catkin_add_gtest|add_rostest|"
    r"protobuf_generate\w*|add_(?:message|service|action)_files|generate_dynamic_reconfigure_options|"
    r"rosbuild_add_(?:executable|library)|cuda_add_(?:executable|library)|qt\d?_(?:wrap_(?:cpp|ui)|add_resources)|"
    r"pluginlib_export_plugin_description_file)\s*\((?P<words>[^()]*)\)",
    re.IGNORECASE,
)
"""The commands of CMake that build or export the files that they name."""
_LIST = re.compile(
    r"\b(?:set\s*\(|list\s*\(\s*(?:APPEND|PREPEND)\b)\s*(?P<variable>\w+)\s(?P<words>[^()]*)\)", re.IGNORECASE
)
"""The commands of CMake that fill a list."""
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_INTERFACE_FOLDERS = {"add_message_files": "msg", "add_service_files": "srv", "add_action_files": "action"}
"""The folders, beside the build file, of the files that commands of catkin name without a folder."""
_CURRENT_FOLDER = re.compile(r"^\"?(?:\$\{(?:CMAKE_CURRENT_SOURCE_DIR|PROJECT_SOURCE_DIR|CMAKE_SOURCE_DIR)\}/|\./)?")
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<](?P<path>[^">\n]+)[">]', re.MULTILINE)
_GENERATED = (".in", ".em", ".msg", ".srv", ".action", ".yaml", ".cfg", ".proto")
"""The ends of the names of files from which headers are generated."""


def find_lost_sources(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the build files and sources that still name a file which only the old version has, with the changes."""
    lost = [
        file.old_path
        for file in changed_files
        if file.old_path and not file.is_submodule and not versions.new.file(file.old_path).exists()
    ]
    for path in versions.new.paths((CMAKE_FILE,)) if lost else ():
        text = _COMMENT.sub(lambda match: " " * len(match[0]), versions.new.text(path))
        yield from ((path, change) for change in _find_lost_words(path, text, lost))
    headers = [path for path in lost if PurePosixPath(path).suffix in HEADER_SUFFIXES]
    yield from _find_lost_includes(versions, headers)


def _find_lost_words(path: str, text: str, lost: Sequence[str]) -> Iterator[Change]:
    """Yield a change for each lost file that a command of a build file names."""
    folder = PurePosixPath(path).parent
    names = {
        PurePosixPath(file).relative_to(folder).as_posix()
        for file in lost
        if PurePosixPath(file).is_relative_to(folder)
    }
    for command in _BUILD.finditer(text) if names else ():
        default_folder = _INTERFACE_FOLDERS.get(command["name"].lower(), "")
        variables = set(_VARIABLE.findall(command["words"]))
        lists = (match for match in _LIST.finditer(text, 0, command.start()) if match["variable"] in variables)
        for match in (command, *lists):
            for word in re.finditer(r"\S+", match["words"]):
                name = _CURRENT_FOLDER.sub("", word[0]).rstrip('"')
                file = name if "DIRECTORY" in command["words"] else (PurePosixPath(default_folder) / name).as_posix()
                if file in names:
                    names.discard(file)
                    line = text[: match.start("words") + word.start()].count("\n") + 1
                    message = phrase("names '{file}', which no longer exists", file=name)
                    yield Change(
                        message, Effect.BREAKING, phrase("the package does not build"), Location(path, line, 1)
                    )


def _find_lost_includes(versions: Versions, headers: Sequence[str]) -> Iterator[tuple[str, Change]]:
    """Yield the files of the packages of lost headers that still include one of them.

    Headers that another file may replace are left out: one of the same name, or one from which it is generated.
    """
    for header in headers:
        package = versions.old.package_of(header)
        if package is None or _may_be_replaced(versions, PurePosixPath(header)):
            continue
        name = PurePosixPath(header).name
        for path in versions.new.paths(CPP_SUFFIXES, package):
            text = versions.new.text(path)
            if name not in text or not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
                continue
            for match in _INCLUDE.finditer(blank_disabled(text)):
                if _is_path_of(header, match["path"], PurePosixPath(path).parent):
                    line = text[: match.start("path")].count("\n") + 1
                    message = phrase("names '{file}', which no longer exists", file=match["path"])
                    yield (
                        path,
                        Change(message, Effect.BREAKING, phrase("the code does not build"), Location(path, line, 1)),
                    )
                    break


def _may_be_replaced(versions: Versions, header: PurePosixPath) -> bool:
    """Return whether the new version has a header of the same name, or a file from which it may be generated."""
    paths = map(PurePosixPath, versions.new.paths((*HEADER_SUFFIXES, *_GENERATED)))
    return any(
        path.name == header.name or (path.suffix not in HEADER_SUFFIXES and path.name.startswith(header.stem))
        for path in paths
    )


def _is_path_of(header: str, included: str, folder: PurePosixPath) -> bool:
    """Return whether an included path means a header: beside the file, or in a folder of headers."""
    beside = header == (folder / included).as_posix()
    return beside or header.endswith(f"/include/{included}") or header == f"include/{included}"
