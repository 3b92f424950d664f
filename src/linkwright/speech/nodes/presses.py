"""Presses of the talk button: a press without an understood command is answered once its sound was processed."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, phrase
from linkwright.speech.engine import Heard

SAY_IT_AGAIN = phrase("I did not hear all of that: please repeat")

_MISSED = 3
"""Presses in a row without any command after which enrolling is proposed."""


@dataclass(slots=True)
class _Press:
    """The results of one press.

    Attributes:
        is_settled: whether a command of this press was executed or answered.
        has_gaps: whether some of its sound was lost.
        unknown: the last recognized text that is not a command.
    """

    is_settled: bool = False
    has_gaps: bool = False
    unknown: Heard | None = None


class Presses:
    """Presses whose sound the engine is still processing; the next press may have begun before that.

    Args:
        can_enrol: whether the words are enrolled in pages, so the user can enrol words that were not understood.

    Attributes:
        proposes_enrolling: whether the answer to the last press proposed enrolling. The next press, or a command,
            withdraws the proposal.
    """

    def __init__(self, *, can_enrol: bool = False) -> None:
        self._can_enrol = can_enrol
        self.proposes_enrolling = False
        self._missed = 0
        self._presses: deque[_Press] = deque()

    def begin(self) -> None:
        """Record that the button was pressed."""
        self.proposes_enrolling = False
        self._presses.append(_Press())

    def settle(self) -> None:
        """Record that a command was executed or answered."""
        self._missed = 0
        self.proposes_enrolling = False
        if self._presses:
            self._presses[0].is_settled = True

    def note_gap(self) -> None:
        """Record that sound was lost since the last press."""
        if self._presses:
            self._presses[-1].has_gaps = True

    def note_unknown(self, heard: Heard) -> None:
        """Record speech that is not a command."""
        if self._presses:
            self._presses[0].unknown = heard

    def end(self) -> Phrase | None:
        """End the oldest press, whose sound was processed, and return the answer to it, or None."""
        if not self._presses:
            return None
        press = self._presses.popleft()
        if press.is_settled or press.unknown is None:
            return None
        if press.has_gaps:
            return SAY_IT_AGAIN
        self._missed += 1
        self.proposes_enrolling = self._can_enrol and self._missed % _MISSED == 0
        if self.proposes_enrolling:
            return phrase("I do not know your words: enrol them in the Voice panel, in the room where you speak")
        if press.unknown.nearest:
            return phrase(
                "I heard something that is not a command: '{text}' is the nearest", text=press.unknown.nearest
            )
        return phrase("I heard something that is not a command")
