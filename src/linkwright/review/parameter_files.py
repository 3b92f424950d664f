"""The comparison of YAML files: parameters of nodes and controllers, and settings that launch files read."""

from __future__ import annotations

import re
from pathlib import Path

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.changes import Location
from linkwright.review.file_pair import FilePair, UnreadableFileError
from linkwright.review.yaml_values import YamlValue, read_yaml_values

_MAX_BYTES = 4 << 20
_OFFERED_NAMES = re.compile(r"(^|[._])(joints?|joint_names?|wheel_names|interfaces|frame_id)$")
"""The parameters with names that a controller or driver offers to other programs, which must not lose one of them."""
_CONTROLLER_TYPE = re.compile(r"controller_manager\.ros__parameters\.(?P<controller>[^.]+)\.type")
_STAMPED = re.compile(r"stamped", re.IGNORECASE)
"""The parameters that choose between messages with and without a header, such as ``use_stamped_vel``."""
_NUMBER_OR_TRUTH = re.compile(r"[-+.\deE]+|true|false", re.IGNORECASE)


def compare_parameter_files(pair: FilePair) -> None:
    """Compare two versions of a YAML file, value by value."""
    values = pair.read(_read)
    if values is None:
        return
    old, new = values
    for name in dict.fromkeys([*new, *old]):
        old_value, new_value = old.get(name), new.get(name)
        if new_value is None and old_value is not None:
            location = Location(pair.old_path, old_value.line, old_value.column, is_old=True)
            text = phrase("{parameter} {value} removed", parameter=name, value=old_value.text)
            pair.add(text, location, _breaking_reason(name, old_value.text, None))
        elif new_value is not None and (old_value is None or not _are_equal(old_value.text, new_value.text)):
            location = Location(pair.new_path, new_value.line, new_value.column)
            if old_value is None:
                pair.add(phrase("{parameter} {value} added", parameter=name, value=new_value.text), location)
                continue
            text = phrase("{parameter} {old} -> {new}", parameter=name, old=old_value.text, new=new_value.text)
            pair.add(text, location, _breaking_reason(name, old_value.text, new_value.text))


def _read(file: Path) -> dict[str, YamlValue]:
    if file.stat().st_size > _MAX_BYTES:
        raise UnreadableFileError(phrase("it is larger than {megabytes} MB", megabytes=_MAX_BYTES >> 20))
    return read_yaml_values(file.read_text(encoding="utf-8"))


def _are_equal(old: str, new: str) -> bool:
    """Return whether two values are equal as texts or as numbers: ``0`` and ``0.000`` are."""
    if old == new:
        return True
    try:
        return [float(word) for word in old.strip("[]").split(", ")] == [
            float(word) for word in new.strip("[]").split(", ")
        ]
    except ValueError:
        return False


def _breaking_reason(parameter: str, old: str, new: str | None) -> Phrase | None:
    """Return why a changed value is breaking, or None if it is not.

    Args:
        parameter: the path of the parameter.
        old: the old value.
        new: the new value; None for a removed parameter.
    """
    controller = _CONTROLLER_TYPE.fullmatch(parameter)
    if controller is not None and new is None:
        return phrase(
            "programs that load or command the controller '{name}' do not find it", name=controller["controller"]
        )
    if new is None:
        return None
    if _STAMPED.search(parameter) and {old.lower(), new.lower()} == {"true", "false"}:
        return phrase("the message type of a topic changes between one with and one without a header")
    gone = _items(old) - _items(new)
    if gone and _OFFERED_NAMES.search(parameter):
        return phrase("programs that use the name '{name}' do not find it", name=", ".join(sorted(gone)))
    return None


def _items(text: str) -> set[str]:
    """Return the items of a value that is a list, or the value itself, without numbers and truth values."""
    items = (item.strip() for item in text.strip("[]").split(","))
    return {item for item in items if item and not _NUMBER_OR_TRUTH.fullmatch(item)}
