"""The definition of a message type as recordings carry it: its own text, then those of the types in it.

The form is MCAP's ``ros2msg`` schema encoding, which is also that of rosbag2's SQLite files.
"""

from __future__ import annotations

import re

from linkwright.messages import definition_text, get_message

_SEPARATOR = "=" * 80
_TYPE = re.compile(r"\b([a-z]\w*)/(?:msg/)?([A-Z]\w*)")


def schema_of(type_name: str) -> str:
    """The definitions of a type and of all types in it.

    Args:
        type_name: such as ``sensor_msgs/msg/JointState``.

    Raises:
        LinkwrightError: MSG101, the type is not known.
    """
    texts = [definition_text(get_message(type_name))]
    seen = {type_name}
    waiting = _types_in(type_name)
    while waiting:
        nested = waiting.pop(0)
        if nested in seen:
            continue
        seen.add(nested)
        package, _, name = nested.split("/")
        texts.append(f"{_SEPARATOR}\nMSG: {package}/{name}\n{definition_text(get_message(nested))}")
        waiting += _types_in(nested)
    return "\n".join(text.rstrip("\n") for text in texts) + "\n"


def _types_in(type_name: str) -> list[str]:
    fields = get_message(type_name).get_fields_and_field_types().values()
    return [f"{match[1]}/msg/{match[2]}" for field in fields for match in _TYPE.finditer(field)]
