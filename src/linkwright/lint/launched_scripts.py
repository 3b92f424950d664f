"""Find scripts that launch files start, but that a package built by CMake does not have."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import LinkwrightError, SourceText, Span
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.xacro.cache import read_document

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext

_SUFFIX = ".py"
_SCRIPT = lazy_pattern(r"[\w-]+\.py")
_MARKUP_SUFFIXES = (".launch", ".launch.xml")
_TEST_FOLDERS = frozenset({"test", "tests"})
_BUILD_FILES = ("CMakeLists.txt", ".cmake", "setup.py")
_COMMENT = lazy_pattern(r"#[^\n]*")
_GENERATION = lazy_pattern(
    r"\b(?:RENAME|configure_file|add_custom_command|add_custom_target|execute_process|ExternalProject_Add"
    r"|FetchContent_\w+|file\s*\(\s*(?:GENERATE|WRITE|DOWNLOAD|COPY|COPY_FILE|CREATE_LINK))\b",
)
"""A command of a build file that can make a script with another name."""
_SUBMODULE = lazy_pattern(r"^[ \t]*path[ \t]*=[ \t]*(?P<path>\S+)")
_SUBMODULES = ".gitmodules"
_MAX_PARENTS = 8


@dataclass(frozen=True, slots=True)
class LaunchedScript:
    """A script that a launch file starts."""

    name: str
    span: Span
    source: SourceText


def find_missing_scripts(package: PackageContext) -> Iterator[LaunchedScript]:
    """Yield the scripts of the package that launch files start and that certainly do not exist.

    A package whose build may make scripts, or that has parts elsewhere, has none.
    """
    missing = [script for script in _list_scripts(package) if not _has_script(package, script.name)]
    if not missing or _has_parts_elsewhere(package):
        return
    texts = [package.text(file) for file in package.files if file.endswith(_BUILD_FILES)]
    build = "\n".join(_COMMENT.sub("", source.text) for source in texts if source is not None)
    if _GENERATION.search(build) is None:
        yield from (script for script in missing if script.name.removesuffix(_SUFFIX) not in build)


def _list_scripts(package: PackageContext) -> Iterator[LaunchedScript]:
    """Yield the scripts of the package that launch files in Python and XML start, except those of tests."""
    for path, file in package.launch_files.items():
        for node in file.nodes if _is_used(path) else ():
            is_own = node.package is not None and node.package.text == package.name
            if is_own and node.executable is not None and _SCRIPT.fullmatch(node.executable.text):
                yield LaunchedScript(node.executable.text, node.executable.span, file.source)
    for path in package.files:
        if path.endswith(_MARKUP_SUFFIXES) and _is_used(path):
            yield from _list_scripts_of_markup(package.folder / path, package.name or "")


def _list_scripts_of_markup(path: Path, package: str) -> Iterator[LaunchedScript]:
    try:
        root = read_document(str(path)).root
    except (LinkwrightError, OSError):
        return
    pending = [root]
    while pending:
        element = pending.pop()
        pending += element.elements()
        name = element.attributes.get("exec", element.attributes.get("type", ""))
        is_own = element.tag == "node" and element.attributes.get("pkg") == package
        if is_own and element.source is not None and _SCRIPT.fullmatch(name):
            end = element.offset + len(element.tag) + 1
            yield LaunchedScript(name, element.source.span(element.offset, end), element.source)


def _has_script(package: PackageContext, name: str) -> bool:
    """Return whether the package has the script, or a file from which it may be made."""
    stem = name.removesuffix(_SUFFIX)
    return any(PurePosixPath(file).name in (name, stem) or file.endswith(f"/{name}.in") for file in package.files)


def _has_parts_elsewhere(package: PackageContext) -> bool:
    """Return whether a folder of the package is a symbolic link or a submodule."""
    folder = package.folder
    if any(child.is_symlink() for child in folder.iterdir()) or any(
        child.is_symlink() for part in package.folders for child in (folder / part).iterdir()
    ):
        return True
    for parent in (folder.absolute(), *list(folder.absolute().parents)[:_MAX_PARENTS]):
        if (parent / _SUBMODULES).is_file():
            text = (parent / _SUBMODULES).read_text("utf-8", errors="replace")
            matches = (_SUBMODULE.match(line) for line in text.splitlines())
            paths = [os.path.normpath(parent / match["path"]) for match in matches if match is not None]
            return any(Path(path).is_relative_to(folder.absolute()) for path in paths)
    return False


def _is_used(path: str) -> bool:
    return _TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)
