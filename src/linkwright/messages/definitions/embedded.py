"""Read the message definitions that recordings contain.

The definition of a message comes first. The definitions of its nested messages follow, each after a line of ``=`` and a
line with the name (``MSG: geometry_msgs/Point``, or ``IDL:`` for IDL). This is the format of MCAP's ``ros2msg`` and
``ros2idl``, and of rosbag2's SQLite files.
"""

from __future__ import annotations

import re

from linkwright.diagnostics import SourceText
from linkwright.messages.definitions.interfaces import split_name
from linkwright.messages.definitions.library import LIBRARY

_SEPARATOR_LINES = re.compile(r"^={10,}\s*\n(MSG|IDL): *(\S+) *\n?", re.MULTILINE)


def add_definitions(type_name: str, text: str, origin: str, *, idl: bool = False) -> None:
    """Register the definitions of a message and its nested messages from a recording.

    Interfaces of Linkwright and of the workspace take precedence. If a name is registered twice, the
    first definition is kept. A definition is parsed, and its mistakes are reported, when the message is requested.

    Args:
        type_name: the type, such as ``my_msgs/msg/Count``; the call has no effect for an invalid name.
        text: the definition of the message, followed by those of its nested messages.
        origin: the origin of the text, such as a file, for error messages.
        idl: whether the first definition is IDL.
    """
    first_definition, *nested_definitions = _SEPARATOR_LINES.split(text)
    _add("IDL" if idl else "MSG", type_name, first_definition, origin)
    for language, name, body in zip(
        nested_definitions[::3], nested_definitions[1::3], nested_definitions[2::3], strict=True
    ):
        _add(language, name, body, origin)


def _add(language: str, name: str, text: str, origin: str) -> None:
    interface_name = split_name(name)
    if interface_name is None or interface_name.kind not in (None, "msg") or not text.strip():
        return
    type_name = f"{interface_name.package}/msg/{interface_name.name}"
    LIBRARY.add_text(type_name, SourceText(f"{origin}/{type_name}.{language.lower()}", text))
