"""Find configurations of fake controllers that start in a state that a semantic description does not have."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.lenient_xml import read_lenient_root
from linkwright.review.versions import Version, Versions

_SRDF, _SRDF_XACRO = ".srdf", ".srdf.xacro"
_SETTINGS = (".yaml", ".yml")
_INITIAL = re.compile(r"^initial:[^\n]*\n(?P<items>(?:[ \t]+[^\n]*\n?|-[^\n]*\n?|[ \t]*#[^\n]*\n?|\n)*)", re.MULTILINE)
_STATE = re.compile(r"-[ \t]+group:[ \t]*(?P<group>[^\s#]+)[^\n]*\n[ \t]+pose:[ \t]*(?P<pose>[^\s#]+)")


def find_lost_states(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the YAML files with initial states that the changed semantic descriptions of their package lack.

    A state that the old version already lacked is left out.
    """
    old_paths = {file.new_path: file.old_path for file in changed_files if file.old_path and file.new_path}
    folders = {
        versions.new.package_of(new_path): versions.old.package_of(old_path)
        for new_path, old_path in old_paths.items()
        if new_path.endswith(_SRDF)
    }
    for folder in sorted(folder for folder in folders if folder is not None):
        old_folder = folders[folder]
        if old_folder is None or next(versions.new.paths((_SRDF_XACRO,), folder), None) is not None:
            continue
        old_states, states = _read_states(versions.old, old_folder), _read_states(versions.new, folder)
        if old_states is None or states is None:
            continue
        for path in versions.new.paths(_SETTINGS, folder):
            old_names = {name for name, _ in _find_initial_states(versions.old, old_paths.get(path, path))}
            for name, location in _find_initial_states(versions.new, path):
                if name not in states and not (name in old_names and name not in old_states):
                    sentence = phrase("names the state '{name}', which does not exist", name=name)
                    reason = phrase("the fake controllers do not find the initial state")
                    yield path, Change(sentence, Effect.BREAKING, reason, location)


def _find_initial_states(version: Version, path: str) -> Iterator[tuple[str, Location]]:
    """Yield the initial states in a file as ``group/state``, with their locations."""
    text = version.text(path)
    for items in _INITIAL.finditer(text):
        for match in _STATE.finditer(text, items.start("items"), items.end("items")):
            line = text.count("\n", 0, match.start("pose")) + 1
            column = match.start("pose") - text.rfind("\n", 0, match.start("pose"))
            yield f"{match['group']}/{match['pose']}", Location(path, line, column)


def _read_states(version: Version, folder: str) -> set[str] | None:
    """Return the states of the semantic descriptions of a package, or None if one of them cannot be read."""
    try:
        roots = [read_lenient_root(version.file(path)) for path in version.paths((_SRDF,), folder)]
    except (LinkwrightError, OSError):
        return None
    return {
        f"{state.attributes.get('group', '')}/{state.attributes.get('name', '')}"
        for root in roots
        for state in root.elements("group_state")
    }
