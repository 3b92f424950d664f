"""A strict reader of the command file, which reports each error with its position."""

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
from linkwright.speech.commands.action_reader import ActionReader
from linkwright.speech.commands.actions import MOTIONS
from linkwright.speech.commands.command_set import ANY, ByLanguage, Command, CommandSet, Destination
from linkwright.speech.commands.keys import Keys
from linkwright.speech.commands.phrases import Template, TemplateError, parse_templates
from linkwright.speech.commands.quantities import GRAMMAR_VALUES, parse_quantity
from linkwright.speech.commands.words import Words, split_into_words

DEFAULT_FILE = Path(__file__).with_name("default.yaml")
"""The commands of a robot that has no command file of its own."""

MAX_PHRASES = 5000
"""The maximum number of phrases in a language, because engines receive them one by one."""

_TOP_KEYS = ("places", "objects", "said", "yes", "no", "commands")
_PLACE_KEYS = ("x", "y", "yaw", "frame", "names")


def read_command_file(path: str | Path) -> CommandSet:
    """Read a command file.

    Raises:
        LinkwrightError: VOICE301, the file cannot be read; VOICE302, its content is invalid; VOICE303, a phrase is
            invalid; VOICE304, two commands share a phrase; VOICE305, a message does not fit its type; VOICE306, there
            are more phrases than engines accept.
    """
    return parse_commands(read_source(Path(path), phrase("file of commands"), "VOICE301"))


def parse_commands(source: SourceText) -> CommandSet:
    """Return the commands in the text of a file. See `read_command_file`."""
    return _Reader(source).read()


class _Reader:
    """A reader of the text of one command file."""

    def __init__(self, source: SourceText) -> None:
        self._document = YamlDocument(source, "VOICE302")
        self._names: dict[str, dict[Words, str]] = {"place": {}, "object": {}}
        self._slot_values: dict[str, dict[str, tuple[str, ...]]] = {}
        self._intent_by_pieces: dict[tuple[Any, ...], str] = {}

    def read(self) -> CommandSet:
        top = Keys(self._document, self._document.root, phrase("a file of commands"), _TOP_KEYS)
        commands = top.mapping("commands")
        if commands is None:
            raise top.error(phrase("'commands' is missing: list the commands for the robot there"))
        if not commands:
            message = phrase("there is no command in 'commands': list the commands for the robot there")
            raise top.error(message, top.node("commands"))
        places = {name: self._read_place(name, node) for name, node in self._read_entries(top, "places")}
        for name, node in self._read_entries(top, "objects"):
            self._read_names("object", name, node)
        for slot, node in self._read_entries(top, "said"):
            self._add_slot_values(slot, node, top)
        answers = {name: self._read_phrases(top.node(name), ()) for name in ("yes", "no")}
        command_list = tuple(self._read_command(intent, node, places) for intent, node in commands)
        command_set = CommandSet(command_list, self._names, self._slot_values, places, answers)
        self._check_phrase_counts(command_set)
        return command_set

    def _read_entries(self, top: Keys, key: str) -> list[tuple[str, yaml.Node]]:
        return top.mapping(key) or []

    def _read_place(self, name: str, node: yaml.Node) -> Destination:
        keys = Keys(self._document, node, phrase("the place '{name}'", name=name), _PLACE_KEYS)
        self._read_names("place", name, keys.node("names"))
        frame = keys.text("frame") or "map"
        return Destination(
            keys.number("x", is_required=True), keys.number("y", is_required=True), keys.number("yaw"), frame
        )

    def _read_names(self, slot: str, name: str, node: yaml.Node | None) -> None:
        """Read the spoken names of a place or an object.

        If there are none, its key is the name.
        """
        texts = self._read_texts(node) if node is not None else {ANY: [(name, None)]}
        spoken_names = self._slot_values.setdefault(slot, {})
        for language, names in texts.items():
            spoken_names[language] = (*spoken_names.get(language, ()), *(text for text, _ in names))
            for text, text_node in names:
                words = split_into_words(text)
                other = self._names[slot].setdefault(words, name)
                if other != name:
                    message = phrase("'{name}' is also a name of '{other_key}'", name=text, other_key=other)
                    raise self._error("VOICE304", message, text_node)

    def _add_slot_values(self, slot: str, node: yaml.Node, top: Keys) -> None:
        if slot not in GRAMMAR_VALUES:
            raise top.error(
                phrase("there is no quantity slot '{slot}'", slot=slot), node, did_you_mean(slot, list(GRAMMAR_VALUES))
            )
        for language, entries in self._read_texts(node).items():
            for text, text_node in entries:
                if parse_quantity(slot, split_into_words(text)) is None:
                    raise self._document.error(
                        phrase("'{value}' is not a value of {slot}", value=text, slot=slot), text_node
                    )
            default_values = GRAMMAR_VALUES[slot].get(language, ())
            self._slot_values.setdefault(slot, dict(GRAMMAR_VALUES[slot]))[language] = (
                *default_values,
                *(text for text, _ in entries),
            )

    def _read_command(self, intent: str, node: yaml.Node, places: Mapping[str, Destination]) -> Command:
        title = phrase("the command '{intent}'", intent=intent)
        keys = Keys(self._document, node, title, ("phrases", "confirm", "response", "moves", *ActionReader.KINDS))
        if keys.node("phrases") is None:
            raise keys.error(phrase("{subject} has no 'phrases': it cannot be spoken", subject=title))
        phrases = self._read_phrases(keys.node("phrases"), tuple(self._names), intent)
        slot_sets = [set(template.slots) for phrase in phrases.values() for template in phrase]
        slots = set.intersection(*slot_sets) if slot_sets else set()
        samples = {slot: next(iter(self._names[slot].values()), "") if slot in self._names else 1.0 for slot in slots}
        action = ActionReader(self._document, keys, places, samples).read()
        if keys.node("stop") is not None and any(slot_sets):
            raise keys.error(phrase("a phrase of 'stop' must not have slots"), keys.node("phrases"))
        is_motion = isinstance(action, MOTIONS) if keys.node("moves") is None else keys.flag("moves")
        response = self._read_first_texts(keys.node("response"))
        return Command(intent, phrases, action, self._read_question(keys), response, is_motion)

    def _read_question(self, keys: Keys) -> ByLanguage:
        node = keys.node("confirm")
        if isinstance(node, yaml.ScalarNode) and node.tag == "tag:yaml.org,2002:bool":
            question = phrase("are you sure?")
            return {language: localized(question, language) for language in LANGUAGES} if keys.flag("confirm") else {}
        return self._read_first_texts(node)

    def _read_first_texts(self, node: yaml.Node | None) -> dict[str, str]:
        return (
            {} if node is None else {name: entries[0][0] for name, entries in self._read_texts(node).items() if entries}
        )

    def _read_phrases(
        self, node: yaml.Node | None, slots: Sequence[str], intent: str = ""
    ) -> dict[str, tuple[Template, ...]]:
        templates_by_language: dict[str, tuple[Template, ...]] = {}
        for language, texts in (self._read_texts(node) if node is not None else {}).items():
            for text, text_node in texts:
                templates_by_language[language] = (
                    *templates_by_language.get(language, ()),
                    *self._parse_templates(text, text_node, slots, intent),
                )
        return templates_by_language

    def _parse_templates(self, text: str, node: yaml.Node | None, slots: Sequence[str], intent: str) -> list[Template]:
        try:
            parsed = parse_templates(text, slots)
        except TemplateError as error:
            raise self._error(
                "VOICE303",
                phrase("the phrase '{phrase}' is invalid: {reason}", phrase=text, reason=error.args[0]),
                node,
            ) from None
        for template in parsed:
            other = self._intent_by_pieces.setdefault((template.pieces, template.slots), intent)
            if intent and other != intent:
                message = phrase("'{phrase}' is also a phrase of '{command}'", phrase=template.text, command=other)
                raise self._error("VOICE304", message, node)
        return parsed

    def _read_texts(self, node: yaml.Node) -> dict[str, list[tuple[str, yaml.Node | None]]]:
        """Return the texts of a node by language, each with its node.

        The node is a text, a list of texts, or a mapping of languages to these.
        """
        if isinstance(node, yaml.MappingNode):
            keys = Keys(self._document, node, phrase("the mapping from languages to strings"), None)
            return {language: keys.texts(language) for language in keys.names()}
        title = "texts"
        return {ANY: Keys.of(self._document, title, node).texts(title)}

    def _check_phrase_counts(self, command_set: CommandSet) -> None:
        languages = {*LANGUAGES, *command_set.languages}
        for language in sorted(languages):
            count = command_set.count_phrases(language)
            if count > MAX_PHRASES:
                message = phrase(
                    "{count} phrases are possible in '{language}', but engines accept at most {maximum}",
                    count=count,
                    language=language,
                    maximum=MAX_PHRASES,
                )
                hint = phrase("use fewer parts in brackets, fewer slots in a phrase, or shorter lists under 'said'")
                raise self._error("VOICE306", message, None, hint)

    def _error(self, code: str, message: Phrase, node: yaml.Node | None, hint: Phrase | None = None) -> LinkwrightError:
        span = self._document.span(node)
        return LinkwrightError(Diagnostic(code, message, span, hint=hint, source=self._document.source))
