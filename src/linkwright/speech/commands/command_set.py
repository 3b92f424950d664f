"""A robot's commands: the matching of texts to commands, and the phrases for engines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import prod

from linkwright.speech.commands.actions import Action, Stop
from linkwright.speech.commands.phrases import Names, Template, Value
from linkwright.speech.commands.quantities import GRAMMAR_VALUES
from linkwright.speech.commands.words import has_words, split_into_words

ANY = "any"
"""The language of phrases that are valid in every language."""

ByLanguage = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Destination:
    """A place that the robot can drive to.

    Attributes:
        x, y: the position in meters.
        yaw: the heading in radians.
        frame: the frame of the pose.
    """

    x: float
    y: float
    yaw: float
    frame: str


@dataclass(frozen=True, slots=True)
class Command:
    """A command of a command file.

    Attributes:
        intent: its name.
        phrases: its phrases by language.
        action: the action that it starts.
        question: by language, the question to ask before the command is executed; empty to execute it immediately.
        response: by language, the answer; empty for the default answer.
        is_motion: whether it replaces a running motion.
    """

    intent: str
    phrases: Mapping[str, tuple[Template, ...]]
    action: Action
    question: ByLanguage
    response: ByLanguage
    is_motion: bool


@dataclass(frozen=True, slots=True)
class Match:
    """A command that was found in a text.

    Attributes:
        command: the command that the text expresses.
        values: the spoken values by slot.
        language: the language of the matching phrase; `ANY` for a phrase that is valid in every language.
    """

    command: Command
    values: Mapping[str, Value]
    language: str


@dataclass(frozen=True, slots=True)
class CommandSet:
    """The commands of a file.

    Attributes:
        commands: the commands in the order of the file.
        names: for each slot that a name replaces (``place``, ``object``), the names by their spoken forms.
        slot_values: for each slot that the file lists, its possible spoken values by language.
        places: the places by name.
        answers: for ``yes`` and ``no``, the spoken forms by language.
    """

    commands: tuple[Command, ...]
    names: Names
    slot_values: Mapping[str, Mapping[str, tuple[str, ...]]]
    places: Mapping[str, Destination]
    answers: Mapping[str, Mapping[str, tuple[Template, ...]]]

    def match_command(self, text: str) -> Match | None:
        """Return the command that a text expresses in any language, or None if there is none.

        If several commands fit, the result is the one with the most literal words and, among these, the first in the
        file.
        """
        words = split_into_words(text)
        best: tuple[int, Match] | None = None
        for command in self.commands:
            for language, templates in command.phrases.items():
                for template in templates:
                    values = template.match(words, self.names)
                    if values is not None and (best is None or template.literal_count > best[0]):
                        best = template.literal_count, Match(command, values, language)
        return None if best is None else best[1]

    @property
    def languages(self) -> tuple[str, ...]:
        """The languages of the commands."""
        return tuple(dict.fromkeys(name for command in self.commands for name in command.phrases))

    @property
    def stop_commands(self) -> tuple[Command, ...]:
        """The commands that stop the robot."""
        return tuple(command for command in self.commands if isinstance(command.action, Stop))

    def is_stop(self, text: str) -> bool:
        """Return whether a text contains a phrase that stops the robot."""
        words = split_into_words(text)
        return any(
            has_words(words, template.pieces[0])
            for stop in self.stop_commands
            for template in _collect_all_templates(stop.phrases)
        )

    def is_other_command(self, text: str) -> bool:
        """Return whether a text is exactly a command that does not stop the robot."""
        match = self.match_command(text)
        return match is not None and not isinstance(match.command.action, Stop)

    def parse_answer(self, text: str) -> bool | None:
        """Return True if a text means yes, False if it means no, and None for any other text."""
        words = split_into_words(text)
        for name, is_yes in (("yes", True), ("no", False)):
            if any(template.match(words, {}) is not None for template in _collect_all_templates(self.answers[name])):
                return is_yes
        return None

    def phrases(self, language: str) -> tuple[str, ...]:
        """Return all phrases in a language, for `EngineOptions`."""
        values = self._collect_slot_values(language)
        return tuple(
            dict.fromkeys(text for template in self._collect_templates(language) for text in template.expand(values))
        )

    def count_phrases(self, language: str) -> int:
        """Return the number of phrases in a language without generating them."""
        values = self._collect_slot_values(language)
        return sum(prod(len(values[slot]) for slot in template.slots) for template in self._collect_templates(language))

    def _collect_slot_values(self, language: str) -> dict[str, tuple[str, ...]]:
        """Return the spoken values of each slot in a language."""
        return {
            slot: tuple(text for name in (language, ANY) for text in texts.get(name, ()))
            for slot, texts in {**GRAMMAR_VALUES, **self.slot_values}.items()
        }

    def _collect_templates(self, language: str) -> list[Template]:
        phrase_sets = [*(command.phrases for command in self.commands), *self.answers.values()]
        return [template for phrases in phrase_sets for name in (language, ANY) for template in phrases.get(name, ())]


def choose_text(texts: ByLanguage, language: str) -> str:
    """Return the text in a language, or the best substitute for it.

    Substitutes are a text for any language, the English text, and any other text, in this order. The result is empty if
    there is no text.
    """
    for name in (language, ANY, "en"):
        if name in texts:
            return texts[name]
    return next(iter(texts.values()), "")


def _collect_all_templates(phrases: Mapping[str, tuple[Template, ...]]) -> list[Template]:
    return [template for phrase in phrases.values() for template in phrase]
