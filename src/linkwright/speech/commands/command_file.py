"""The command file in YAML, read strictly, with errors at their positions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    SourceText,
    did_you_mean,
    phrase,
)
from linkwright.diagnostics.translation import LANGUAGES, localized
from linkwright.files.yaml_documents import YamlDocument, read_source
from linkwright.speech.commands.action_reading import ActionReader
from linkwright.speech.commands.actions import MOTIONS
from linkwright.speech.commands.command_set import ANY, ByLanguage, Command, CommandSet, Place
from linkwright.speech.commands.phrases import Template, TemplateError, templates
from linkwright.speech.commands.quantities import SAYABLE, quantity
from linkwright.speech.commands.reading import Keys
from linkwright.speech.commands.words import Words, words_of

DEFAULT_FILE = Path(__file__).with_name("default.yaml")
"""The commands of a robot that was given none."""

MOST_PHRASES = 5000
"""Engines get all phrases, one by one."""

_TOP = ("places", "objects", "said", "yes", "no", "commands")
_PLACE = ("x", "y", "yaw", "frame", "names")


def read_command_file(path: str | Path) -> CommandSet:
    """Read a command file.

    Raises:
        LinkwrightError: VOICE301, it cannot be read; VOICE302, it is invalid; VOICE303, a phrase is invalid; VOICE304,
            two commands share a phrase; VOICE305, a message does not fit its type; VOICE306, there are more phrases
            than engines accept.
    """
    return parse_commands(read_source(Path(path), phrase("file of commands"), "VOICE301"))


def parse_commands(source: SourceText) -> CommandSet:
    """Return the commands in the text of a file; see `read_command_file`."""
    return _Reader(source).read()


class _Reader:
    """Reads the text of one command file."""

    def __init__(self, source: SourceText) -> None:
        self._document = YamlDocument(source, "VOICE302")
        self._names: dict[str, dict[Words, str]] = {"place": {}, "object": {}}
        self._slot_values: dict[str, dict[str, tuple[str, ...]]] = {}
        self._seen: dict[tuple[Any, ...], str] = {}

    def read(self) -> CommandSet:
        top = Keys(self._document, self._document.root, phrase("a file of commands"), _TOP)
        commands = top.mapping("commands")
        if commands is None:
            raise top.error(phrase("'commands' is missing: it lists the commands for the robot"))
        if not commands:
            message = phrase("there is no command in 'commands': it lists the commands for the robot")
            raise top.error(message, top.node("commands"))
        places = {name: self._place(name, node) for name, node in self._entries(top, "places")}
        for name, node in self._entries(top, "objects"):
            self._name("object", name, node)
        for slot, node in self._entries(top, "said"):
            self._add_slot_values(slot, node, top)
        answers = {name: self._phrases(top.node(name), ()) for name in ("yes", "no")}
        read = tuple(self._command(intent, node, places) for intent, node in commands)
        found = CommandSet(read, self._names, self._slot_values, places, answers)
        self._count(found)
        return found

    def _entries(self, top: Keys, key: str) -> list[tuple[str, yaml.Node]]:
        return top.mapping(key) or []

    def _place(self, name: str, node: yaml.Node) -> Place:
        keys = Keys(self._document, node, phrase("the place '{name}'", name=name), _PLACE)
        self._name("place", name, keys.node("names"))
        frame = keys.text("frame") or "map"
        return Place(keys.number("x", needed=True), keys.number("y", needed=True), keys.number("yaw"), frame)

    def _name(self, slot: str, name: str, node: yaml.Node | None) -> None:
        """Read the spoken names of a place or an object; without names, its key is used."""
        texts = self._texts(node) if node is not None else {ANY: [(name, None)]}
        spoken = self._slot_values.setdefault(slot, {})
        for language, names in texts.items():
            spoken[language] = (*spoken.get(language, ()), *(text for text, _ in names))
            for text, where in names:
                words = words_of(text)
                other = self._names[slot].setdefault(words, name)
                if other != name:
                    message = phrase("'{text}' is also a name of '{other}'", text=text, other=other)
                    raise self._error("VOICE304", message, where)

    def _add_slot_values(self, slot: str, node: yaml.Node, top: Keys) -> None:
        if slot not in SAYABLE:
            raise top.error(
                phrase("there is no quantity slot '{slot}'", slot=slot), node, did_you_mean(slot, list(SAYABLE))
            )
        for language, entries in self._texts(node).items():
            for text, where in entries:
                if quantity(slot, words_of(text)) is None:
                    raise self._document.error(phrase("'{text}' is not a value of {slot}", text=text, slot=slot), where)
            usual = SAYABLE[slot].get(language, ())
            self._slot_values.setdefault(slot, dict(SAYABLE[slot]))[language] = (*usual, *(text for text, _ in entries))

    def _command(self, intent: str, node: yaml.Node, places: Mapping[str, Place]) -> Command:
        what = phrase("the command '{intent}'", intent=intent)
        keys = Keys(self._document, node, what, ("phrases", "confirm", "response", "moves", *ActionReader.KINDS))
        if keys.node("phrases") is None:
            raise keys.error(phrase("{what} has no 'phrases': it cannot be spoken", what=what))
        phrases = self._phrases(keys.node("phrases"), tuple(self._names), intent)
        every = [set(template.slots) for phrase in phrases.values() for template in phrase]
        slots = set.intersection(*every) if every else set()
        samples = {slot: next(iter(self._names[slot].values()), "") if slot in self._names else 1.0 for slot in slots}
        action = ActionReader(self._document, keys, places, samples).read()
        if keys.node("stop") is not None and any(every):
            raise keys.error(phrase("a phrase of 'stop' must not have slots"), keys.node("phrases"))
        moves = isinstance(action, MOTIONS) if keys.node("moves") is None else keys.flag("moves")
        response = self._one_text(keys.node("response"))
        return Command(intent, phrases, action, self._question(keys), response, moves)

    def _question(self, keys: Keys) -> ByLanguage:
        node = keys.node("confirm")
        if isinstance(node, yaml.ScalarNode) and node.tag == "tag:yaml.org,2002:bool":
            question = phrase("are you sure?")
            return {language: localized(question, language) for language in LANGUAGES} if keys.flag("confirm") else {}
        return self._one_text(node)

    def _one_text(self, node: yaml.Node | None) -> dict[str, str]:
        return {} if node is None else {name: entries[0][0] for name, entries in self._texts(node).items() if entries}

    def _phrases(
        self, node: yaml.Node | None, slots: Sequence[str], intent: str = ""
    ) -> dict[str, tuple[Template, ...]]:
        found: dict[str, tuple[Template, ...]] = {}
        for language, texts in (self._texts(node) if node is not None else {}).items():
            for text, where in texts:
                found[language] = (*found.get(language, ()), *self._templates(text, where, slots, intent))
        return found

    def _templates(self, text: str, where: yaml.Node | None, slots: Sequence[str], intent: str) -> list[Template]:
        try:
            read = templates(text, slots)
        except TemplateError as error:
            raise self._error(
                "VOICE303", phrase("the phrase '{text}': {why}", text=text, why=error.args[0]), where
            ) from None
        for template in read:
            other = self._seen.setdefault((template.pieces, template.slots), intent)
            if intent and other != intent:
                message = phrase("'{text}' is also a phrase of '{other}'", text=template.text, other=other)
                raise self._error("VOICE304", message, where)
        return read

    def _texts(self, node: yaml.Node) -> dict[str, list[tuple[str, yaml.Node | None]]]:
        """Return texts with their positions by language.

        The node is a text, a list of texts, or a mapping of languages to these.
        """
        if isinstance(node, yaml.MappingNode):
            keys = Keys(self._document, node, phrase("strings by language"), None)
            return {language: keys.texts(language) for language in keys.names()}
        what = "texts"
        return {ANY: Keys.of(self._document, what, node).texts(what)}

    def _count(self, found: CommandSet) -> None:
        languages = {*LANGUAGES, *found.languages}
        for language in sorted(languages):
            count = found.phrase_count(language)
            if count > MOST_PHRASES:
                message = phrase(
                    "{count} phrases are possible in '{language}', but engines accept at most {most}",
                    count=count,
                    language=language,
                    most=MOST_PHRASES,
                )
                hint = phrase("use fewer parts in brackets, fewer slots in a phrase, or shorter lists under 'said'")
                raise self._error("VOICE306", message, None, hint)

    def _error(self, code: str, message: Phrase, node: yaml.Node | None, hint: Phrase | None = None) -> LinkwrightError:
        span = self._document.span(node)
        return LinkwrightError(Diagnostic(code, message, span, hint=hint, source=self._document.source))
