"""The definition of a message type, followed by the definitions of the types in it.

The format is MCAP's ``ros2msg`` schema encoding, which rosbag2's SQLite files and Foxglove use, too.
"""

from __future__ import annotations

from linkwright.messages.classes import get_message
from linkwright.messages.message import definition_of
from linkwright.messages.presentation import definition_text

_SEPARATOR = "=" * 80


def schema_of(type_name: str) -> str:
    """Return the definitions of a type and of all types in it, as MCAP's ``ros2msg`` schema.

    Args:
        type_name: the type, such as ``sensor_msgs/msg/JointState``, or the type of a service's events.

    Raises:
        LinkwrightError: MSG101, the type is not known.
    """
    texts = [_text(type_name)]
    seen = {type_name}
    waiting = _types_in(type_name)
    while waiting:
        nested = waiting.pop(0)
        if nested in seen:
            continue
        seen.add(nested)
        texts.append(f"{_SEPARATOR}\nMSG: {nested.replace('/msg/', '/')}\n{_text(nested)}")
        waiting += _types_in(nested)
    return "\n".join(text.rstrip("\n") for text in texts) + "\n"


def _text(type_name: str) -> str:
    """Return the text of a message definition.

    For a request or response, which no file defines, the text is generated from the fields.
    """
    if "/msg/" in type_name:
        return definition_text(type_name)
    lines = []
    for field in definition_of(get_message(type_name)).fields:
        base = field.type.base
        package, _, name = base.rpartition("/")
        spelled = field.type.to_msg_text()
        if "/srv" in package:  # `to_msg_text` omits the kind from the name, but requests and responses need it.
            spelled = spelled.replace(f"{package.partition('/')[0]}/{name}", base, 1)
        lines.append(f"{spelled} {field.name}")
    return "\n".join(lines)


def _types_in(type_name: str) -> list[str]:
    return list(definition_of(get_message(type_name)).references)
