"""Fixes of build files and manifests: missing dependencies, and missing install rules.

The new lines have the format of the adjacent lines. There is no fix for a file in which the location of a new line is
uncertain.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from pathlib import PurePosixPath

from linkwright.lint.fix import Edit, Fix
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.xmltree.patches import find_element_range, line_ending

if TYPE_CHECKING:
    from linkwright.diagnostics import SourceText
    from linkwright.lint.package import PackageContext
    from linkwright.packages.readers.cmake_syntax import Statement, Token
    from linkwright.packages.readers.package_xml import Manifest
    from linkwright.packages.readers.setup_py import SetupFile

_SHARE_FOLDER = "share/${PROJECT_NAME}"
_REST_OF_ENTRY = lazy_pattern(r"[ \t]*(,?)[ \t]*(#[^\n]*)?")
_LAST_COMMAND = lazy_pattern(r"^[ \t]*ament_(auto_)?package[ \t]*\(", re.MULTILINE | re.IGNORECASE)
_JOINED_PATH = lazy_pattern(r"\(\s*os\.path\.join\(\s*['\"]share['\"],\s*package_name\b")
_FIRST_IMPORT = lazy_pattern(r"^(import|from)[ \t]", re.MULTILINE)


def make_dependency_fix(manifest: Manifest, names: list[str], tag: str = "exec_depend") -> Fix | None:
    """Return the fix that adds dependencies to ``package.xml``, or None if it is impossible.

    The new lines follow the last dependency that is not only for tests or documentation, or else the license. They have
    its indentation.

    Args:
        manifest: the manifest to which the dependencies are added.
        names: the names of the packages.
        tag: the tag of the new elements.
    """
    source = manifest.document.source
    dependencies = manifest.dependencies
    run_time = [dependency for dependency in dependencies if dependency.tag not in ("test_depend", "doc_depend")]
    last = (run_time or dependencies)[-1].element if dependencies else manifest.root.first("license")
    last_range = None if last is None else find_element_range(last)
    if source is None or last is None or last_range is None:
        return None
    line = source.text.rfind("\n", 0, last.offset) + 1
    indent = source.text[line : last.offset]
    if indent.strip():
        return None
    newline = line_ending(source.text)
    text = "".join(f"{newline}{indent}<{tag}>{name}</{tag}>" for name in names)
    return Fix((Edit(source.name, last_range[1], last_range[1], text),))


def make_setup_folders_fix(
    package: PackageContext, setup: SetupFile, folders: Iterable[str], *, safe: bool
) -> Fix | None:
    """Return the fix that adds folders to ``data_files`` in ``setup.py``, or None."""
    glob, imports = _find_glob(setup)
    if glob is None:
        return None
    entries = [
        f"({_format_share_folder(setup, package.name, folder)}, {_format_patterns(package, folder, glob)})"
        for folder in folders
    ]
    return _make_data_files_fix(setup, entries, imports, safe=safe)


def make_setup_file_fix(package: PackageContext, setup: SetupFile, destination: str, file: str) -> Fix | None:
    """Return the fix that adds a file to the ``data_files`` of ``setup.py``.

    The result is None if the position of the new entry is uncertain.

    Args:
        package: the package that contains the file.
        setup: its ``setup.py``.
        destination: the folder relative to the prefix; an empty string for the share folder of the package.
        file: the path of the file in the package.
    """
    into = f"'{destination}'" if destination else _format_share_folder(setup, package.name)
    return _make_data_files_fix(setup, [f"({into}, ['{file}'])"], (), safe=True)


def make_cmake_folder_fix(source: SourceText, folder: str, *, safe: bool) -> Fix | None:
    """Return the fix that installs a folder by ``CMakeLists.txt``.

    The result is None if the position of the new command is uncertain.

    A folder directly in the package is added to a command that installs folders into the share folder. For any other
    folder, or without such a command, a command is added before ``ament_package()``.

    Args:
        source: the ``CMakeLists.txt``.
        folder: the path of the folder in the package.
        safe: whether the fix is safe.
    """
    text, parent = source.text, str(PurePosixPath(folder).parent)
    last = None if parent != "." else next(_find_last_folders(source), None)
    if last is not None:
        end = last.end + (1 if last.is_quoted else 0)
        line = text.rfind("\n", 0, last.start) + 1
        blanks = text[line : last.start].removesuffix('"')
        separator = f"{line_ending(text)}{blanks}" if not blanks.strip() else " "
        return Fix((Edit(source.name, end, end, f"{separator}{folder}"),), safe)
    last_command = _LAST_COMMAND.search(text)
    if last_command is None:
        return None
    destination = _SHARE_FOLDER if parent == "." else f"{_SHARE_FOLDER}/{parent}"
    newline = line_ending(text)
    command = f"install(DIRECTORY {folder} DESTINATION {destination}){newline}{newline}"
    return Fix((Edit(source.name, last_command.start(), last_command.start(), command),), safe)


def _find_last_folders(source: SourceText) -> Iterator[Token]:
    """Yield the last folder of each unconditional command that installs into the share folder."""
    from linkwright.packages.readers.cmake_syntax import BLOCK_ENDS, parse_statements

    depth = 0
    for statement in parse_statements(source):
        depth += statement.name in BLOCK_ENDS
        depth -= statement.name in BLOCK_ENDS.values()
        if depth == 0 and statement.name == "install":
            folders = _find_installed_folders(statement)
            if folders:
                yield folders[-1]


def _find_installed_folders(statement: Statement) -> tuple[Token, ...]:
    words = [token.text for token in statement.tokens]
    if (
        words[:1] != ["DIRECTORY"]
        or len(words) < 4
        or words[-2] != "DESTINATION"
        or words[-1].rstrip("/") != _SHARE_FOLDER
    ):
        return ()
    folders = statement.tokens[1:-2]
    return () if any(folder.text.endswith("/") or "$" in folder.text for folder in folders) else folders


def _make_data_files_fix(setup: SetupFile, entries: list[str], imports: tuple[Edit, ...], *, safe: bool) -> Fix | None:
    """Return the fix that adds entries to ``data_files``, or None if this is not possible."""
    data_files = _find_data_files_list(setup)
    if data_files is None:
        return None
    source, text = setup.source, setup.source.text
    start, elements = data_files
    if '"' in text and text.count('"') > text.count("'"):
        entries = [entry.replace("'", '"') for entry in entries]
    if elements:
        edit = _insert_after_last(source, elements[-1], entries)
    else:
        edit = Edit(source.name, start + 1, start + 1, ", ".join(entries))
    if any(import_edit.start > edit.start for import_edit in imports):  # the import would come after its use
        return None
    edits = (*imports, edit)
    changed_text = text
    for applied in sorted(edits, key=lambda edit: edit.start, reverse=True):
        changed_text = changed_text[: applied.start] + applied.replacement + changed_text[applied.end :]
    try:
        ast.parse(changed_text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    return Fix(edits, safe)


def _insert_after_last(source: SourceText, last: tuple[int, int], entries: list[str]) -> Edit:
    """Return the edit that inserts entries after the last entry.

    If the last entry is on its own line, so is each new entry.
    """
    text, (start, end) = source.text, last
    indent = text[text.rfind("\n", 0, start) + 1 : start]
    if indent.strip():
        return Edit(source.name, end, end, "".join(f", {entry}" for entry in entries))
    separator = f"{line_ending(text)}{indent}"
    rest_match = _REST_OF_ENTRY.match(text, end)
    if rest_match is not None and rest_match[1] and rest_match[2]:  # a comment belongs to the entry before it
        offset = end + len(rest_match[0].rstrip("\r"))
        return Edit(source.name, offset, offset, "".join(f"{separator}{entry}," for entry in entries))
    return Edit(source.name, end, end, "".join(f",{separator}{entry}" for entry in entries))


def _find_data_files_list(setup: SetupFile) -> tuple[int, list[tuple[int, int]]] | None:
    """Return the offset of the list ``data_files`` in the call of ``setup``, and its elements.

    The elements are ranges of offsets. The result is None if there is no such list.
    """
    from linkwright.packages.readers.python_values import PythonFile, argument_of

    try:
        python_file = PythonFile(setup.source)
    except (SyntaxError, ValueError):
        return None
    call = next(python_file.calls("setup"), None)
    node = None if call is None else argument_of(call, "data_files")
    node = None if node is None else python_file.resolved(node)
    if not isinstance(node, ast.List):
        return None
    spans = [python_file.span(element) for element in (node, *node.elts)]
    offset = setup.source.offset
    ranges = [(offset(span.line, span.column), offset(span.end_line, span.end_column)) for span in spans]
    return ranges[0][0], ranges[1:]


def _find_glob(setup: SetupFile) -> tuple[str | None, tuple[Edit, ...]]:
    """Return the name of ``glob`` in ``setup.py``, and the edit that imports it.

    The edit is empty if the import exists. The name is None if there is no position for the import.
    """
    for node in () if setup.tree is None else setup.tree.body:
        if isinstance(node, ast.ImportFrom) and node.module == "glob":
            name = next((alias.asname or alias.name for alias in node.names if alias.name == "glob"), None)
            if name is not None:
                return name, ()
        if isinstance(node, ast.Import):
            name = next((alias.asname or alias.name for alias in node.names if alias.name == "glob"), None)
            if name is not None:
                return f"{name}.glob", ()
    text = setup.source.text
    first = _FIRST_IMPORT.search(text)
    if first is None or text.startswith("from __future__", first.start()):
        return None, ()
    return "glob", (Edit(setup.source.name, first.start(), first.start(), f"from glob import glob{line_ending(text)}"),)


def _format_share_folder(setup: SetupFile, name: str, folder: str = "") -> str:
    """Return the expression of a folder in the share folder, in the form of the other entries."""
    text, subpath = setup.source.text, f"/{folder}" if folder else ""
    if _JOINED_PATH.search(text):
        return "os.path.join('share', package_name" + (f", '{folder}')" if folder else ")")
    if re.search(rf"^package_name\s*=\s*['\"]{re.escape(name)}['\"]", text, re.MULTILINE):
        return "'share/' + package_name" + (f" + '{subpath}'" if subpath else "")
    return f"'share/{name}{subpath}'"


def _format_patterns(package: PackageContext, folder: str, glob: str) -> str:
    """Return the expression that lists the files in a folder.

    If the folder has subfolders, the expression has one pattern for each extension, because a folder in ``data_files``
    is an error. Files without an extension are then left out.
    """
    if not any(other.startswith(f"{folder}/") for other in package.folders):
        return f"{glob}('{folder}/*')"
    files = [file for file in package.files if file.rpartition("/")[0] == folder]
    endings = sorted({PurePosixPath(file).suffix for file in files})
    return " + ".join(f"{glob}('{folder}/*{ending}')" for ending in endings if ending)
