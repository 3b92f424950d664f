"""Hints about a line of a node that fails."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase

_COUNTS = re.compile(r"(\w+)\(\) takes (\d+) positional arguments? but (\d+) (?:was|were) given")
_MESSAGE_EXPECTED = re.compile(r"Expected <class '[\w.]+\.(\w+)'>, got <class '(?:float|int|str|bool)'>")
_MESSAGE_CALL = re.compile(r"\b([A-Z]\w*)\(")


def hint_about_line(error: Exception, line: str) -> Phrase | None:
    """Return a hint about a node's exception, given the line that raised it, or None."""
    text = str(error)
    if type(error).__name__ == "NotInitializedException":
        return phrase("write rclpy.init(), with parentheses, before the first node is created")
    if "create_" in line:
        return _hint_about_creation(text, line)
    if "'node_name'" in text and "missing" in text:
        return _hint_about_name(line)
    if "destruction was requested" in text:
        return phrase("rclpy.shutdown() or destroy_node() was called before this line; call it at the end")
    if "already declared" in text:
        return phrase("declare a parameter once, in __init__")
    if "'Duration' object has no attribute" in text:
        return phrase("a difference of two times has nanoseconds; a second has 1e9 of them")
    return _hint_about_value(text, line)


def _hint_about_creation(text: str, line: str) -> Phrase | None:
    """Return a hint about a call such as ``create_publisher``, or None."""
    if "'qos_profile'" in text and "missing" in text:
        return phrase("pass the number of messages that may wait as the last argument, such as 10")
    if "missing" in text and "()" in line:
        return phrase("pass the function without parentheses, such as self.on_message")
    if "create_timer" in line and "float()" in text:
        return phrase("pass the period in seconds before the function: create_timer(0.1, self.move)")
    if "'type' is not iterable" in text:
        return phrase("pass the type before the name, as in create_publisher(Twist, 'cmd_vel', 10)")
    if "'method' is not iterable" in text:
        return phrase("pass the type, the name, the function and the queue: (Odometry, 'odom', self.on_odometry, 10)")
    if "callback should be" in text:
        return phrase("give the function a parameter for the message: def on_message(self, message)")
    return None


def _hint_about_name(line: str) -> Phrase:
    if "super()" in line:
        return phrase("write the name of the node: super().__init__('NAME')")
    return phrase(
        "its class needs a method __init__, with two underscores on both sides, which calls super().__init__('NAME')"
    )


def _hint_about_value(text: str, line: str) -> Phrase | None:
    """Return a hint about a value or an argument with a wrong type, or None."""
    if "must be of type 'float'" in text:
        if "get_parameter(" in line and ".value" not in line:
            return phrase("write .value after get_parameter(...)")
        if "get_parameter(" in line:
            return phrase("declare the parameter with a number with a point, such as 0.2")
        return phrase("write the number with a point, such as 1.0; float(...) converts a value")
    if match := _MESSAGE_EXPECTED.search(text):
        return phrase("put the value into a message: {name}(data=...)", name=match[1])
    if "the response of" in text:
        return phrase("end the callback of the service with 'return response'")
    match = _COUNTS.search(text)
    if match is None:
        return None
    if match[1] == "__init__" and (call := _MESSAGE_CALL.search(line)):
        return phrase("name the field of the message, as in {name}(data=...)", name=call[1])
    return phrase(
        "it is called with {count} arguments besides self; give '{name}' a parameter for each of them",
        count=int(match[3]) - 1,
        name=match[1],
    )
