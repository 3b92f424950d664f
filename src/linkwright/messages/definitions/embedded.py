"""The message definitions that recordings contain.

The text of one message comes first. The texts of the messages in it follow, each after a line of ``=`` and a line with
its name (``MSG: geometry_msgs/Point``; ``IDL:`` for IDL). This is the format of MCAP's ``ros2msg`` and ``ros2idl``, and
of rosbag2's SQLite files.
"""

from __future__ import annotations

import re

from linkwright.diagnostics import SourceText
from linkwright.messages.definitions.interfaces import split_name
from linkwright.messages.definitions.library import LIBRARY

_NEXT = re.compile(r"^={10,}\s*\n(MSG|IDL): *(\S+) *\n?", re.MULTILINE)


def add_definitions(type_name: str, text: str, origin: str, *, idl: bool = False) -> None:
    """Register the definition of a message, and of the messages in it, from data.

    Interfaces that come with Linkwright and those of the workspace take precedence. If a name is registered twice, the
    first text is kept. The texts are parsed when their messages are requested, and mistakes in them are reported then.

    Args:
        type_name: the type, such as ``my_msgs/msg/Count``; a text that is not the name of a message is ignored.
        text: the definitions.
        origin: the source of the texts, for messages about mistakes in them.
        idl: whether the first definition is IDL.
    """
    first, *others = _NEXT.split(text)
    _add("IDL" if idl else "MSG", type_name, first, origin)
    for language, name, body in zip(others[::3], others[1::3], others[2::3], strict=True):
        _add(language, name, body, origin)


def _add(language: str, name: str, text: str, origin: str) -> None:
    split = split_name(name)
    if split is None or split.kind not in (None, "msg") or not text.strip():
        return
    type_name = f"{split.package}/msg/{split.name}"
    LIBRARY.add_text(type_name, SourceText(f"{origin}/{type_name}.{language.lower()}", text))
