"""Find sensors of Gazebo that only have another name, or another tag for the frame, so that values are compared."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from linkwright.descriptions.comparison import SAME_TAGS, Difference
from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.diagnostics.phrase import as_phrase
from linkwright.loading.lean_dataclasses import replace
from linkwright.review.plugins import is_added, is_removed
from linkwright.review.renames.replaced_plugins import PluginReplacement
from linkwright.xmltree import Element

_SENSOR = "sensor"
_SAME_TYPES = {"ray": "lidar", "gpu_ray": "lidar", "gpu_lidar": "lidar"}
"""Types of sensors with the same messages."""
_FRAME_TAG = re.compile(r"((gz|ignition)_)?frame_id|frame_?[nN]ame")
_FRAME_PATH = re.compile(r"(?P<sensor>.*\bsensor \S+) (?:(?:(?:gz|ignition)_)?frame_id|camera optical_frame_id)")
"""The path of the frame of a sensor's messages. The images of a camera have its optical frame, if it has one."""
_MAX_VALUES = 12


@dataclass(frozen=True, slots=True)
class SensorReplacement(PluginReplacement):
    """A sensor with another name."""

    @property
    def text(self) -> Phrase:
        """The names of both sensors, and the values that differ."""
        text = phrase("sensor '{old}' renamed to '{new}'", old=self.old or "", new=self.new or "")
        old, new = (_read_values(sensor) for sensor in (self.old_plugin, self.new_plugin) if sensor is not None)
        values = list(_compare_values(old, new))
        return phrase("{change}: {values}", change=text, values=joined_first(values, _MAX_VALUES)) if values else text

    @property
    def lost_frame(self) -> str | None:
        """The frame of the messages that the new sensor does not name; None if there is none."""
        old, new = (_find_frames(sensor) for sensor in (self.old_plugin, self.new_plugin))
        return next((frame for frame in old if frame not in new), None)


def merge_renamed_sensors(differences: Iterable[Difference]) -> list[Difference]:
    """Return the differences, with a removed and an added sensor of one type in the same place as one difference.

    The place must lose and gain only one sensor of this type.
    """
    result = list(differences)
    added, removed = (
        _group_sensors(difference for difference in result if is_side(difference)) for is_side in (is_added, is_removed)
    )
    for key, (old,) in ((key, group) for key, group in removed.items() if len(group) == 1):
        if len(added.get(key, ())) != 1:
            continue
        (new,) = added[key]
        assert old.element is not None
        assert new.element is not None
        replacement = SensorReplacement(
            new.subject,
            new.name,
            "changed",
            new.property,
            old.element.attributes.get("name", ""),
            new.element.attributes.get("name", ""),
            "",
            old.old_place,
            new.new_place,
            None,
            old.element,
            new.element,
        )
        result = [replacement if item is new else item for item in result if item is not old]
    return result


def merge_sensor_frames(differences: Iterable[Difference]) -> list[Difference]:
    """Return the differences, with a removed and an added frame of one sensor as one, if the frames differ.

    Their tags may differ, because the one that counts depends on the version of Gazebo.
    """
    result = list(differences)
    added = {match["sensor"]: item for item, match in _match_frames(result) if is_added(item)}
    for old, match in _match_frames(result):
        new = added.get(match["sensor"])
        if not is_removed(old) or new is None:
            continue
        values = [item.element.text().strip() for item in (old, new) if item.element is not None]
        if len(values) == 2 and values[0] != values[1]:
            changed = replace(new, old=values[0], new=values[1], old_place=old.old_place, element=None)
            result = [changed if item is new else item for item in result if item is not old]
    return result


def _match_frames(differences: Iterable[Difference]) -> Iterator[tuple[Difference, re.Match[str]]]:
    """Yield the differences in frames of sensors, with the matches of their paths."""
    for difference in differences:
        match = _FRAME_PATH.fullmatch(f"{difference.name} {difference.property}".strip())
        if match is not None:
            yield difference, match


def _group_sensors(differences: Iterable[Difference]) -> dict[tuple[str, str], list[Difference]]:
    """Return the added or removed sensors by the names of their extensions and their types."""
    groups: dict[tuple[str, str], list[Difference]] = {}
    for difference in differences:
        element = difference.element
        if element is not None and element.tag == _SENSOR and difference.kind == "changed":
            sensor_type = element.attributes.get("type", "")
            groups.setdefault((difference.name, _SAME_TYPES.get(sensor_type, sensor_type)), []).append(difference)
    return groups


def _read_values(element: Element, path: str = "") -> dict[str, str]:
    """Return the texts in an element, by the tags of the elements around them."""
    values: dict[str, str] = {}
    for child in element.elements():
        name = " ".join(filter(None, (path, SAME_TAGS.get(child.tag, child.tag))))
        text = " ".join(child.text().split())
        if text:
            values[name] = text
        values |= _read_values(child, name)
    return values


def _compare_values(old: Mapping[str, str], new: Mapping[str, str]) -> Iterator[Phrase]:
    for name, value in new.items():
        if name not in old:
            yield phrase("{element} added", element=f"{name} {value}")
        elif old[name] != value:
            yield as_phrase(f"{name} {old[name]} -> {value}")
    for name, value in old.items():
        if name not in new:
            yield phrase("{element} removed", element=f"{name} {value}")


def _find_frames(sensor: Element | None) -> list[str]:
    elements = () if sensor is None else sensor.walk()
    return [element.text().strip().lstrip("/") for element in elements if _FRAME_TAG.fullmatch(element.tag)]
