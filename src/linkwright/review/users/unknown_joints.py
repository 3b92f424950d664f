"""Find parameters that named a joint of a robot, and now name a similar one that no robot has."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.yaml_values import YamlValue, read_yaml_values
from linkwright.review.users.left_robot_names import RobotFiles, RobotName
from linkwright.review.versions import TEST_FOLDERS, Versions

_SUFFIXES = (".yaml", ".yml")
_JOINT = re.compile(r"\w+_joint")
_MIN_SIMILARITY = 0.6
"""The minimum similarity of both names, so that they name parts of one robot."""


def find_unknown_joints(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the changed parameter files that newly name an unknown joint, each with a change.

    A joint is unknown if no robot of the repository has it, and no macro of another repository may make it. A name that
    is the old one with a prefix is not reported: a caller may pass the prefix.
    """
    files = RobotFiles(versions.new)
    for file in changed_files:
        path = file.new_path
        if path is None or file.old_path is None or file.is_submodule or not path.endswith(_SUFFIXES):
            continue
        if not TEST_FOLDERS.isdisjoint(path.split("/")):
            continue
        for old, value in _find_changed_joints(versions.old.text(file.old_path), versions.new.text(path)):
            new = value.text.strip("\"'")
            is_known = files.may_define(RobotName(new, path, is_frame=False)) or files.is_in_robot(new)
            if is_known or files.may_make(new) or not files.may_define(RobotName(old, path, is_frame=False)):
                continue
            text = phrase("names the joint '{name}' instead of '{old}', but no robot has it", name=new, old=old)
            reason = phrase("the joint '{name}' is not found", name=new)
            yield path, Change(text, Effect.BREAKING, reason, Location(path, value.line, value.column))


def _find_changed_joints(old_text: str, new_text: str) -> Iterator[tuple[str, YamlValue]]:
    """Yield the names of joints that changed to similar ones: the old name and the new value."""
    try:
        old_values, new_values = read_yaml_values(old_text), read_yaml_values(new_text)
    except UnreadableFileError:
        return
    for key, value in new_values.items():
        if key not in old_values or value.is_list or old_values[key].is_list:
            continue
        old, new = (item.text.strip("\"'") for item in (old_values[key], value))
        is_renamed = old != new and _JOINT.fullmatch(old) and _JOINT.fullmatch(new)
        is_prefixed = new.endswith(old) or old.endswith(new)
        ratio = SequenceMatcher(None, old, new, autojunk=False).ratio() if is_renamed else 0.0
        if ratio >= _MIN_SIMILARITY and not is_prefixed:
            yield old, value
