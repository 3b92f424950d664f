"""Find configurations of fake controllers with a state or joint that a semantic description does not have."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.files.parameters.moveit_names import make_uncontrolled_reason
from linkwright.review.lenient_xml import read_lenient_root
from linkwright.review.versions import Version, Versions

_SRDF, _SRDF_XACRO = ".srdf", ".srdf.xacro"
_SETTINGS = (".yaml", ".yml")
_JOINT = "joint"
_FAKE_CONTROLLERS = "fake_controllers.yaml"
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


def find_lost_joints(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the fake controllers with a joint that the groups of a semantic description have replaced by others.

    Groups that newly have a chain or link may have any joint.
    """
    for file in changed_files:
        if not file.old_path or not file.new_path or not file.new_path.endswith(_SRDF):
            continue
        old, new = (_read_group_parts(v, p) for v, p in ((versions.old, file.old_path), (versions.new, file.new_path)))
        folder = versions.new.package_of(file.new_path)
        if folder is None or any(tag != _JOINT for tag, _ in new - old):
            continue
        lost = {name for tag, name in old - new if tag == _JOINT}
        for path in versions.new.paths((_FAKE_CONTROLLERS,), folder) if lost else ():
            lines = versions.new.text(path).splitlines()
            joints = [line.strip().removeprefix("-").strip() for line in lines]
            added = sorted(name for _, name in new - old if name not in joints)
            for number, name in enumerate(joints):
                if name in lost and added:
                    sentence = phrase("names the joint '{name}', which no group has any more", name=name)
                    location = Location(path, number + 1, lines[number].index(name) + 1)
                    yield path, Change(sentence, Effect.BREAKING, make_uncontrolled_reason(added), location)


def _read_group_parts(version: Version, path: str) -> set[tuple[str, str]]:
    """Return the tags and names of the joints, links and chains of the groups of a semantic description."""
    try:
        root = read_lenient_root(version.file(path))
    except (LinkwrightError, OSError):
        return set()
    parts = (part for group in root.elements("group") for part in group.elements())
    return {(part.tag, part.attributes.get("name", str(sorted(part.attributes.items())))) for part in parts}


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
