"""Presses of the talk button.

A press without a command is answered after its sound has been processed.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, phrase
from linkwright.speech.engine import Heard

PLEASE_REPEAT = phrase("I did not hear all of that, please repeat")

_MISSES_BEFORE_PROPOSAL = 3
"""The number of consecutive presses without a command after which enrolling is proposed."""


@dataclass(slots=True)
class _Press:
    """The words that were recognized during one press.

    Attributes:
        has_command: whether a command of this press was executed or answered.
        has_gaps: whether some of its sound was lost.
        unknown: the last recognized speech that is not a command.
    """

    has_command: bool = False
    has_gaps: bool = False
    unknown: Heard | None = None


class ButtonPresses:
    """The presses whose sound the engine still processes, even if the next press has begun.

    Args:
        can_enroll: whether pages can enroll words, so that the user can enroll words that were not understood.

    Attributes:
        proposes_enrolling: whether the answer to the last press proposed enrolling. The next press, or a command,
            withdraws the proposal.
    """

    def __init__(self, *, can_enroll: bool = False) -> None:
        self._can_enroll = can_enroll
        self.proposes_enrolling = False
        self._missed_presses = 0
        self._presses: deque[_Press] = deque()

    def begin(self) -> None:
        """Record that the button is pressed."""
        self.proposes_enrolling = False
        self._presses.append(_Press())

    def record_command(self) -> None:
        """Record that a command of the oldest press was executed or answered."""
        self._missed_presses = 0
        self.proposes_enrolling = False
        if self._presses:
            self._presses[0].has_command = True

    def record_gap(self) -> None:
        """Record that sound of the latest press was lost."""
        if self._presses:
            self._presses[-1].has_gaps = True

    def record_unknown_speech(self, result: Heard) -> None:
        """Record speech of the oldest press that is not a command."""
        if self._presses:
            self._presses[0].unknown = result

    def end(self) -> Phrase | None:
        """End the oldest press after its sound was processed, and return the answer to it, or None."""
        if not self._presses:
            return None
        press = self._presses.popleft()
        if press.has_command or press.unknown is None:
            return None
        if press.has_gaps:
            return PLEASE_REPEAT
        self._missed_presses += 1
        self.proposes_enrolling = self._can_enroll and self._missed_presses % _MISSES_BEFORE_PROPOSAL == 0
        if self.proposes_enrolling:
            return phrase("I do not recognize your words: enroll them in the Voice panel, in the room where you speak")
        if press.unknown.nearest:
            return phrase(
                "I heard something that is not a command; the most similar one is '{phrase}'",
                phrase=press.unknown.nearest,
            )
        return phrase("I heard something that is not a command")
