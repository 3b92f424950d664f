"""Set a message's fields from a dictionary."""

from typing import Any

from linkwright.messages import set_fields


def set_message_fields(
    msg: Any, values: dict[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[Any]:
    """Set the fields of a message from a dictionary.

    Returns:
        A function for each ``auto`` or ``now``; call it with the Time at which the message is sent, to set the stamp.

    Raises:
        AttributeError: a field does not exist.
        TypeError: a value is invalid for its field.
    """
    return list(set_fields(msg, values, expand_header_auto=expand_header_auto, expand_time_now=expand_time_now))
