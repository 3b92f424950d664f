"""Find inputs of filters that newly name a topic of a controller which the repository does not have."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.files.parameters.yaml_values import YamlValue
from linkwright.review.versions import TEST_FOLDERS, Versions

_INPUT = re.compile(r"(?:.*\.)?(?:(?:odom|imu|twist|pose)\d+|odom(?:etry)?_topic)")
_CONTROLLER_TOPIC = re.compile(r"/?(?:[\w/]+/)?(?P<controller>\w*(?:controller|broadcaster))/\w+")
_CONFIGURATIONS = (".yaml", ".yml")
_SEARCHED_SUFFIXES = (*_CONFIGURATIONS, ".py", ".launch", ".xml", ".xacro", ".urdf", ".sdf", ".cpp", ".hpp", ".h")


def find_unpublished_reason(versions: Versions, path: str, name: str, old: YamlValue, new: YamlValue) -> Phrase | None:
    """Return the reason why another input of a filter is breaking, or None if it is not.

    A parameter file must have the old controller, and no other file outside of tests may name the new one.

    Args:
        versions: both versions of the repository.
        path: the path of the parameter file in the new version.
        name: the path of the parameter.
        old: its old value.
        new: its new value.
    """
    matches = [_CONTROLLER_TOPIC.fullmatch(value.text) for value in (old, new)]
    if _INPUT.fullmatch(name) is None or matches[0] is None or matches[1] is None:
        return None
    before, after = (match["controller"] for match in matches if match is not None)
    others = [
        other
        for other in versions.new.paths(_SEARCHED_SUFFIXES)
        if other != path and TEST_FOLDERS.isdisjoint(PurePosixPath(other).parts)
    ]
    key = re.compile(rf"^\s*{before}\s*:", re.MULTILINE)
    has_old = any(key.search(versions.new.text(other)) for other in others if other.endswith(_CONFIGURATIONS))
    word = re.compile(rf"(?<!\w){after}(?!\w)")
    if before == after or not has_old or any(word.search(versions.new.text(other)) for other in others):
        return None
    return phrase("no controller publishes '{topic}'; parameter files have '{name}'", topic=new.text, name=before)
