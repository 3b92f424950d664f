"""Find launch files of ROS 2 that newly pass arguments which the included file does not use."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import counted, quoted_names
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Location
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.argument_uses import is_used, read_code, uses_computed_arguments
from linkwright.review.launches.arguments.passed import find_passed, names_outside_of_keys
from linkwright.review.launches.outlines import PASSES_ALL_ARGUMENTS, Entry, LaunchOutline
from linkwright.review.launches.programs.sources import try_read_outline
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.versions import Version, Versions

_MODULES = "json|math|os|pathlib|re|subprocess|sys|tempfile|typing|xacro|yaml"
_LOCAL_IMPORT = re.compile(rf"^\s*(?:from|import)\s+(?!launch|ament_index_python|(?:{_MODULES})\b)\w", re.MULTILINE)
"""An import of a module whose functions may read arguments."""


def find_ignored_arguments(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the changed launch files of ROS 2 that newly pass arguments without an effect, each with a change.

    Launch accepts them without a message.
    """
    for file in changed_files:
        if file.new_path is None or not is_launch_file(file.new_path):
            continue
        known = set() if file.old_path is None else {key for key, _ in _find_ignored(versions.old, file.old_path)}
        groups: dict[str, tuple[Entry, list[str]]] = {}
        for (included_path, name), entry in _find_ignored(versions.new, file.new_path):
            was_used = versions.old.file(included_path).is_file() and not _ignores(versions.old, included_path, name)
            if (included_path, name) not in known and not was_used:
                groups.setdefault(included_path, (entry, []))[1].append(name)
        for included_path, (entry, names) in groups.items():
            names = sorted(set(names))
            text = counted(
                "passes {names} to '{file}', which does not use this argument",
                "passes {names} to '{file}', which uses none of these arguments",
                len(names),
                names=quoted_names(names),
                file=included_path,
            )
            yield file.new_path, Change(text, location=Location(file.new_path, entry.span.line, entry.span.column))


def _find_ignored(version: Version, path: str) -> Iterator[tuple[tuple[str, str], Entry]]:
    """Yield the included files with the arguments that they ignore, and the includes that pass these.

    An include also sets the argument for the actions after it, so that the file must not use the name, unless the
    include passes on the file's own argument of the name.
    """
    code = read_code(version.file(path))
    includes = list(find_passed(version, path))
    outline = try_read_outline(version, path)
    count = sum(entry.kind == "include" for entry in outline.entries) if outline is not None else 0
    if outline is None or outline.is_ros1 or PASSES_ALL_ARGUMENTS in code:
        return
    for entry, included_path, passed in includes:
        for name in sorted(passed):
            is_same = entry.settings.get(name) == f"$(var {name})"
            if not is_same and (count > 1 or _uses(path, code, outline, name)):
                continue
            if _ignores(version, included_path, name):
                yield (included_path, name), entry


def _uses(path: str, code: str, outline: LaunchOutline, name: str) -> bool:
    """Return whether a launch file may use an argument that it passes."""
    return is_used(name, outline.entries) or (path.endswith(PYTHON_SUFFIX) and names_outside_of_keys(code, name))


def _ignores(version: Version, path: str, name: str) -> bool:
    """Return whether a launch file, which includes nothing, certainly does not use an argument."""
    outline = try_read_outline(version, path)
    if outline is None or outline.is_ros1 or outline.has_unknown_actions:
        return False
    if any(entry.kind in ("include", "action") for entry in outline.entries):
        return False
    code = read_code(version.file(path))
    if uses_computed_arguments(code) or _LOCAL_IMPORT.search(code):
        return False
    return not re.search(rf"(?<![\w.-]){re.escape(name)}(?![\w.-])", code)
