"""Write the definition of a message type, followed by the definitions of its nested types.

The format is MCAP's ``ros2msg`` schema encoding, which rosbag2's SQLite files and Foxglove also use.
"""

from __future__ import annotations

from linkwright.messages.classes import get_message
from linkwright.messages.message import definition_of
from linkwright.messages.presentation import definition_text

_SEPARATOR = "=" * 80


def schema_of(type_name: str) -> str:
    """Return the definitions of a type and of its nested types, as MCAP's ``ros2msg`` schema.

    Args:
        type_name: the type, such as ``sensor_msgs/msg/JointState``, or the type of a service's events.

    Raises:
        LinkwrightError: MSG101, the type does not exist.
    """
    texts = [_text(type_name)]
    written_types = {type_name}
    pending = _nested_types(type_name)
    while pending:
        nested_type = pending.pop(0)
        if nested_type in written_types:
            continue
        written_types.add(nested_type)
        texts.append(f"{_SEPARATOR}\nMSG: {nested_type.replace('/msg/', '/')}\n{_text(nested_type)}")
        pending += _nested_types(nested_type)
    return "\n".join(text.rstrip("\n") for text in texts) + "\n"


def _text(type_name: str) -> str:
    """Return the text of a message definition.

    A request or response does not have a file, so its text is generated from the fields.
    """
    if "/msg/" in type_name:
        return definition_text(type_name)
    lines = []
    for field in definition_of(get_message(type_name)).fields:
        base = field.type.base
        package, _, name = base.rpartition("/")
        type_text = field.type.to_msg_text()
        if "/srv" in package:  # `to_msg_text` omits the kind from the name, but requests and responses need it.
            type_text = type_text.replace(f"{package.partition('/')[0]}/{name}", base, 1)
        lines.append(f"{type_text} {field.name}")
    return "\n".join(lines)


def _nested_types(type_name: str) -> list[str]:
    return list(definition_of(get_message(type_name)).references)
