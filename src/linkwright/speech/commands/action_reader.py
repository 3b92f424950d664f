"""The actions of a command file, read and checked against the types of their messages."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase
from linkwright.files.yaml_documents import YamlDocument
from linkwright.messages import get_action, get_message, get_service, set_fields
from linkwright.speech.commands.actions import (
    Action,
    Amount,
    CallService,
    Drive,
    GoTo,
    Launch,
    Publish,
    ScaleSpeed,
    SendGoal,
    SetSpeed,
    Slot,
    Stop,
    Values,
    fill_template,
)
from linkwright.speech.commands.command_set import Destination
from linkwright.speech.commands.keys import Keys

_SLOT_PATTERN = re.compile(r"\{(\w+)\}")
_GRIPPER_TYPE = "control_msgs/action/GripperCommand"


class ActionReader:
    """A reader of the action of one command.

    Args:
        document: the document that contains the command.
        keys: the keys of the command.
        places: the places that the file defines.
        samples: an example value for each slot that occurs in all phrases of the command.

    Attributes:
        KINDS: the keys that define the action of a command.
    """

    KINDS: ClassVar[tuple[str, ...]] = (
        *("drive", "stop", "scale_speed", "set_speed", "go_to"),
        *("gripper", "action", "service", "publish", "launch"),
    )

    def __init__(self, document: YamlDocument, keys: Keys, places: Mapping[str, Destination], samples: Values) -> None:
        self._document, self._keys, self._places, self._samples = document, keys, places, samples

    def read(self) -> Action:
        """Return the action of the command.

        Raises:
            LinkwrightError: VOICE302, there is not exactly one action, or it is invalid; VOICE305, its fields do not
                fit the type of its message.
        """
        kinds = [kind for kind in self.KINDS if self._keys.node(kind) is not None]
        if len(kinds) != 1:
            all_kinds = ", ".join(self.KINDS)
            message = (
                phrase(
                    "{subject} has two actions, '{action}' and '{other_action}'",
                    subject=self._keys.subject,
                    action=kinds[0],
                    other_action=kinds[1],
                )
                if kinds
                else phrase("{subject} has no action", subject=self._keys.subject)
            )
            raise self._keys.error(message, None, phrase("add one of {known}", known=all_kinds))
        readers: dict[str, Callable[[], Action]] = {
            "drive": self._read_drive,
            "stop": self._read_stop,
            "scale_speed": self._read_scale_speed,
            "set_speed": lambda: SetSpeed(self._read_amount(self._keys, "set_speed")),
            "go_to": self._read_go_to,
            "gripper": self._read_gripper,
            "action": self._read_action,
            "service": self._read_service,
            "publish": self._read_publish,
            "launch": self._read_launch,
        }
        return readers[kinds[0]]()

    def _nested_keys(self, key: str, allowed: tuple[str, ...]) -> Keys:
        return Keys(self._document, self._keys.node(key), phrase("'{key}'", key=key), allowed)

    def _read_drive(self) -> Action:
        keys = self._nested_keys("drive", ("x", "y", "turn", "duration", "distance", "angle"))
        limits = [name for name in ("duration", "distance", "angle") if keys.node(name) is not None]
        x, y, turn = (keys.number(name) for name in ("x", "y", "turn"))
        if not (x or y or turn):
            raise keys.error(phrase("'drive' has no motion: give 'x', 'y' or 'turn'"))
        if len(limits) > 1:
            message = phrase(
                "'drive' must have either '{key}' or '{other_key}', not both", key=limits[0], other_key=limits[1]
            )
            raise keys.error(message)
        if limits == ["distance"] and not (x or y):
            raise keys.error(phrase("a rotation has no 'distance': give 'angle'"), keys.node("distance"))
        if limits == ["angle"] and not turn:
            raise keys.error(phrase("a straight drive has no 'angle': give 'distance'"), keys.node("angle"))
        amounts = {name: self._read_amount(keys, name) for name in limits}
        return Drive(x, y, turn, **amounts)

    def _read_stop(self) -> Action:
        if isinstance(self._keys.node("stop"), yaml.MappingNode):
            keys = self._nested_keys("stop", ("publish",))
            return Stop((self._read_publication(keys.node("publish")),))
        if not self._keys.flag("stop"):
            raise self._keys.error(phrase("'stop' must be true"), self._keys.node("stop"))
        return Stop()

    def _read_scale_speed(self) -> Action:
        factor = self._keys.number("scale_speed")
        if not factor > 0.0:
            raise self._keys.error(
                phrase("'{key}' must be more than 0", key="scale_speed"), self._keys.node("scale_speed")
            )
        return ScaleSpeed(factor)

    def _read_go_to(self) -> Action:
        node = self._keys.node("go_to")
        if isinstance(node, yaml.ScalarNode):
            keys, key, action = self._keys, "go_to", ""
        else:
            keys, key = self._nested_keys("go_to", ("place", "action")), "place"
            action = keys.text("action")
        text = keys.text(key, is_required=True)
        slot = self._find_slot(text, keys, key)
        if slot is None and text not in self._places:
            message = phrase("there is no place '{name}'", name=text)
            raise keys.error(message, keys.node(key), did_you_mean(text, list(self._places)))
        if slot is not None and slot.name != "place":
            raise keys.error(
                phrase("'{key}' must be the name of a place, or {slot}", key=key, slot="{place}"), keys.node(key)
            )
        return GoTo(slot or text, action or "navigate_to_pose")

    def _read_gripper(self) -> Action:
        keys = self._nested_keys("gripper", ("action", "position", "max_effort"))
        goal = {
            "command": {"position": keys.number("position", is_required=True), "max_effort": keys.number("max_effort")}
        }
        return SendGoal(keys.text("action", is_required=True), _GRIPPER_TYPE, goal)

    def _read_action(self) -> Action:
        keys = self._nested_keys("action", ("name", "type", "goal"))
        name, type_name, goal = self._read_typed_message(keys, "goal", lambda name: get_action(name).Goal)
        return SendGoal(name, type_name, goal)

    def _read_service(self) -> Action:
        keys = self._nested_keys("service", ("name", "type", "request"))
        name, type_name, request = self._read_typed_message(keys, "request", lambda name: get_service(name).Request)
        return CallService(name, type_name, request)

    def _read_publish(self) -> Action:
        return self._read_publication(self._keys.node("publish"))

    def _read_publication(self, node: yaml.Node | None) -> Publish:
        keys = Keys(self._document, node, phrase("'{key}'", key="publish"), ("topic", "type", "message"))
        name, type_name, message = self._read_typed_message(keys, "message", get_message)
        return Publish(name, type_name, message)

    def _read_launch(self) -> Action:
        keys = self._nested_keys("launch", ("package", "file", "arguments"))
        package, file = keys.text("package", is_required=True), keys.text("file", is_required=True)
        arguments = self._read_fields(keys, "arguments")
        for name, value in arguments.items():
            if not str(name).isidentifier() or isinstance(value, dict | list):
                raise keys.error(phrase("'arguments' must map names to strings or numbers"), keys.node("arguments"))
        if file.startswith("-") or package.startswith("-"):
            raise keys.error(phrase("'launch' must name a package and a file"))
        return Launch(package, file, arguments)

    def _read_typed_message(
        self, keys: Keys, fields_key: str, get_message_class: Callable[[str], Any]
    ) -> tuple[str, str, dict[str, Any]]:
        """Return the name, type and fields of a message to send.

        The fields are checked with an example value in each slot.
        """
        name = keys.text("topic" if fields_key == "message" else "name", is_required=True)
        type_name = keys.text("type", is_required=True)
        values = self._read_fields(keys, fields_key)
        checked_key = "type"
        try:
            message = get_message_class(type_name)()
            checked_key = fields_key
            set_fields(message, fill_template(values, self._samples), expand_header_auto=True, expand_time_now=True)
        except LinkwrightError as error:
            diagnostic = error.diagnostics[0]
            span = self._document.span(keys.node(checked_key) or keys.node("type"))
            source = self._document.source
            raise LinkwrightError(
                Diagnostic("VOICE305", diagnostic.message, span, hint=diagnostic.hint, source=source)
            ) from None
        return name, type_name, values

    def _read_fields(self, keys: Keys, key: str) -> dict[str, Any]:
        values = keys.data(key)
        if not isinstance(values, dict):
            raise keys.error(phrase("'{key}' must be a mapping of keys to values", key=key), keys.node(key))
        for text in _collect_texts(values):
            for name in _SLOT_PATTERN.findall(text):
                self._find_slot(f"{{{name}}}", keys, key)
        return values

    def _read_amount(self, keys: Keys, key: str) -> Amount:
        node = keys.node(key)
        slot = self._find_slot(str(node.value), keys, key) if isinstance(node, yaml.ScalarNode) else None
        if slot is not None:
            if isinstance(self._samples[slot.name], str):
                raise keys.error(phrase("'{key}' must be a number or a quantity", key=key), node)
            return slot
        value = keys.number(key)
        if not value > 0.0:
            raise keys.error(phrase("'{key}' must be more than 0", key=key), node)
        return value

    def _find_slot(self, text: str, keys: Keys, key: str) -> Slot | None:
        """Return the slot that a text consists of, or None if it is not a slot.

        Raises:
            LinkwrightError: a phrase of the command lacks this slot.
        """
        match = _SLOT_PATTERN.fullmatch(text)
        if match is None:
            return None
        if match[1] not in self._samples:
            message = phrase(
                "'{slot}' does not occur in every phrase of {subject}", slot=text, subject=self._keys.subject
            )
            raise keys.error(message, keys.node(key))
        return Slot(match[1])


def _collect_texts(value: Any) -> list[str]:
    if isinstance(value, dict):
        return [text for item in value.values() for text in _collect_texts(item)]
    if isinstance(value, list):
        return [text for part in value for text in _collect_texts(part)]
    return [value] if isinstance(value, str) else []
