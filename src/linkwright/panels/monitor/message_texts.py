"""Messages as texts in YAML, which the user edits in panels."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import LinkwrightError, foreign, phrase
from linkwright.messages.field_values import StampSetter, set_fields


class MessageTextError(Exception):
    """Raised if a text is not the YAML of a message; the text of the error is for the user."""


def fill_message(message: Any, text: str) -> list[StampSetter]:
    """Set the fields of a message from YAML.

    Returns:
        A function for each ``auto`` or ``now``, which sets the time.

    Raises:
        MessageTextError: the text is not YAML, or a value does not fit the message.
    """
    import yaml

    try:
        values = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise MessageTextError(phrase("the values are not YAML: {error}", error=foreign(error))) from None
    if values is None:
        return []
    if not isinstance(values, dict):
        raise MessageTextError(phrase("write 'field: value', one field in a line"))
    try:
        return set_fields(message, values, expand_header_auto=True, expand_time_now=True)
    except LinkwrightError as error:
        raise MessageTextError(error.diagnostics[0].message) from None
