"""The exception of a check that is not satisfied yet."""

from __future__ import annotations

from linkwright.diagnostics import Phrase
from linkwright.learning.local_text import LocalText


class NotYet(Exception):  # noqa: N818 - not an error, but the usual state of a step
    """Raised by a check that is not satisfied yet.

    Args:
        message: one sentence with the actual and the expected state, for lessons in one language.
        texts: the sentence by language, as in ``NotYet(en="The wheel is too large.", zh="轮子太大。")``.

    Attributes:
        text: the sentence in each language.
    """

    def __init__(self, message: Phrase | str = "", **texts: str) -> None:
        if isinstance(message, Phrase):
            self.text = LocalText.from_phrase(message)
        else:
            self.text = LocalText({"en": message, **texts} if message else texts)
        super().__init__(str(self.text))


def expect(condition: object, message: Phrase | str = "", **texts: str) -> None:
    """Raise `NotYet` with the given texts unless a condition is true.

    Raises:
        NotYet: the condition is false.
    """
    if not condition:
        raise NotYet(message, **texts)
