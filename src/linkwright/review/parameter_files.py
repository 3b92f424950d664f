"""The comparison of YAML files: parameters of nodes and controllers, and settings that launch files read."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.diagnostics import Phrase, counted, phrase
from linkwright.review.changes import Location
from linkwright.review.file_pair import FilePair, LimitError
from linkwright.review.list_changes import change_text, list_items
from linkwright.review.yaml_values import YamlValue, read_yaml_values

_MAX_BYTES = 4 << 20
_OFFERED_NAMES = re.compile(r"(^|[._])(joints?|joint_names?|wheel_names|interfaces|frame_id)$")
"""The parameters with names that a controller or driver offers to other programs, which must not lose one of them."""
_CONTROLLER_TYPE = re.compile(r"(?:[^.]+\.)?controller_manager\.ros__parameters\.(?P<controller>[^.]+)\.type")
_STAMPED = re.compile(r"stamped", re.IGNORECASE)
"""The parameters that choose between messages with and without a header, such as ``use_stamped_vel``."""
_STAMPED_BY_DEFAULT = "use_stamped_vel"
"""The parameter of diff_drive_controller and its relatives, which is true by default."""
_NUMBER_OR_TRUTH = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?|true|false", re.IGNORECASE)


def compare_parameter_files(pair: FilePair) -> None:
    """Compare two versions of a YAML file, value by value."""
    values = pair.read(_read)
    if values is None:
        return
    old, new = values
    for name, value in new.items():
        old_value = old.get(name)
        if old_value is not None and not _are_equal(old_value.text, value.text):
            location = Location(pair.new_path, value.line, value.column)
            pair.add(
                change_text(name, old_value.text, value.text),
                location,
                _breaking_reason(name, old_value.text, value.text),
            )
    for name, values_below in _lone_parts(new, old):
        location = Location(pair.new_path, values_below[0].line, values_below[0].column)
        pair.add(_lone_text(name, values_below, is_added=True), location)
    for name, values_below in _lone_parts(old, new):
        location = Location(pair.old_path, values_below[0].line, values_below[0].column, is_old=True)
        below = [(each, old[each].text) for each in old if each not in new and _is_below(each, name)]
        reasons = (_removal_reason(parameter, value, new) for parameter, value in below)
        reason = next((reason for reason in reasons if reason is not None), None)
        pair.add(_lone_text(name, values_below, is_added=False), location, reason)


def _lone_parts(
    values: Mapping[str, YamlValue], others: Mapping[str, YamlValue]
) -> Iterator[tuple[str, list[YamlValue]]]:
    """Yield the parts of a file that another version does not have, as large as possible, with their values."""
    other_parts = {part for name in others for part in _parts(name)}
    parts: dict[str, list[tuple[str, YamlValue]]] = {}
    for name, value in values.items():
        if name not in others:
            part = next((part for part in _parts(name) if part not in other_parts), name)
            parts.setdefault(part, []).append((name, value))
    for part, named_values in parts.items():
        yield named_values[0][0] if len(named_values) == 1 else part, [value for _, value in named_values]


def _parts(name: str) -> list[str]:
    """Return the paths of the mappings that contain a value, the outermost first, and the path of the value."""
    words = name.split(".")
    return [".".join(words[: count + 1]) for count in range(len(words))]


def _is_below(name: str, part: str) -> bool:
    return name == part or name.startswith(f"{part}.")


def _lone_text(name: str, values: Sequence[YamlValue], *, is_added: bool) -> Phrase:
    if len(values) > 1:
        part = counted("{parameter} with {count} value", "{parameter} with {count} values", len(values), parameter=name)
    else:
        part = phrase("{parameter} {value}", parameter=name, value=values[0].text)
    return phrase("{part} added", part=part) if is_added else phrase("{part} removed", part=part)


def _read(file: Path) -> dict[str, YamlValue]:
    if file.stat().st_size > _MAX_BYTES:
        raise LimitError(phrase("it is larger than {megabytes} MB", megabytes=_MAX_BYTES >> 20))
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


def _breaking_reason(parameter: str, old: str, new: str) -> Phrase | None:
    """Return why a changed value is breaking, or None if it is not."""
    if _STAMPED.search(parameter) and {old.lower(), new.lower()} == {"true", "false"}:
        return phrase("the message type of a topic changes between one with and one without a header")
    gone = _items(old) - _items(new)
    if gone and _OFFERED_NAMES.search(parameter):
        return phrase("programs that use the name '{name}' do not find it", name=", ".join(sorted(gone)))
    return None


def _removal_reason(parameter: str, old: str, new: Mapping[str, YamlValue]) -> Phrase | None:
    """Return why a removed parameter is breaking, or None if it is not.

    The type of a controller can also be one of its own parameters.
    """
    if parameter.endswith(_STAMPED_BY_DEFAULT) and old.lower() == "false":
        return phrase("the message type of a topic changes between one with and one without a header")
    controller = _CONTROLLER_TYPE.fullmatch(parameter)
    if controller is None or any(name.endswith(f"{controller['controller']}.ros__parameters.type") for name in new):
        return None
    return phrase("programs that load or command the controller '{name}' do not find it", name=controller["controller"])


def _items(text: str) -> set[str]:
    """Return the items of a value that is a list, or the value itself, without numbers and truth values."""
    return {item for item in list_items(text) if item and not _NUMBER_OR_TRUTH.fullmatch(item)}
