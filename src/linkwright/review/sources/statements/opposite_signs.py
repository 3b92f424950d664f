"""Find fields of received messages that count with the opposite sign now."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.sources.names import NameKind, SourceNames

_FIELD = r"(?P<field>[A-Za-z_]\w*(?:\[\w*\])?(?:(?:\.|->)\w+(?:\[\w*\])?)+)"
_FLIP = re.compile(
    rf"(?<![\w.>*/+-])(?:{_FIELD} -> -(?P=field)|-{_FIELD.replace('field', 'negative')} -> (?P=negative))"
    r"(?![\w.(*/+\[-])"
)
"""A field such as ``msg->linear.x`` that gets or loses a sign, and no other change."""


def find_opposite_reason(text: Phrase, names: SourceNames) -> Phrase | None:
    """Return the reason why changed values are breaking; None if no field of a received message changes its sign.

    Args:
        text: the line about the values of a function.
        names: the names of the new source.
    """
    callback = names.find_callback(str(text.arguments.get("name", "")))
    if callback is None or callback[0] is not NameKind.SUBSCRIPTION:
        return None
    if _FLIP.search(str(text.arguments.get("values", ""))) is None:
        return None
    return phrase("the same messages of '{name}' mean the opposite now", name=callback[1])
