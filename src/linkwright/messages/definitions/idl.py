"""Parse ``.idl`` files, limited to the part of the language that ROS interfaces use.

The supported constructs are those that rosidl generates from ``.msg``, ``.srv`` and ``.action`` files: modules,
structures of primitives, strings, sequences and arrays, typedefs of these, constants, and ``@default``. Other
annotations are skipped. Any other construct, such as a union or an enumeration, is an error with its location.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple, NoReturn

from linkwright.diagnostics import Diagnostic, Phrase, SourceText, did_you_mean, phrase, quoted
from linkwright.messages.definitions.interfaces import (
    EMPTY_MEMBER,
    Constant,
    Container,
    Definition,
    Field,
    FieldType,
    Structure,
    build_interface,
)
from linkwright.messages.definitions.parser import SECTIONS, KnownMessages, LiteralError, read_constant, read_default
from linkwright.messages.errors import DefinitionError

_TOKEN_PATTERN = re.compile(
    r"""(?P<skip>\s+ | //[^\n]* | /\*.*?\*/ | \#[^\n]*)
      | (?P<text>L?"(?:\\.|[^"\\])*" | L?'(?:\\.|[^'\\])*')
      | (?P<number>[-+]?(?:0[xX][0-9a-fA-F]+ | (?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)[dDfF]?)
      | (?P<name>[A-Za-z_]\w*(?:::[A-Za-z_]\w*)*)
      | (?P<mark>::|[{}()<>\[\];:,=@])""",
    re.VERBOSE | re.DOTALL,
)
_PRIMITIVES = {
    "boolean": "bool",
    "octet": "byte",
    "float": "float32",
    "double": "float64",
    "short": "int16",
    "unsigned short": "uint16",
    "long": "int32",
    "unsigned long": "uint32",
    "long long": "int64",
    "unsigned long long": "uint64",
    **{name: name for name in ("int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64")},
}
_UNSUPPORTED_TYPES = {"char", "wchar", "long double", "any", "map", "fixed", "enum", "union", "bitmask", "bitset"}
_PRIMITIVE_KEYWORDS = {"unsigned", "long", "short", "double"}

ENUMERATION = "enum"
"""The type of the constants that are the values of an enumeration."""


class _Token(NamedTuple):
    kind: str
    text: str
    start: int


def parse_idl(source: SourceText, type_name: str, known_messages: KnownMessages) -> Definition:
    """Parse an ``.idl`` file.

    Args:
        source: the content of the file.
        type_name: the name of the interface, such as ``my_msgs/msg/Count``.
        known_messages: determines which messages exist, to check references.

    Raises:
        DefinitionError: MSG120 for text that cannot be parsed; MSG111, MSG114, MSG118 and MSG119 as for other files.
    """
    reader = _Reader(source, known_messages)
    reader.read_definitions(())
    return _assemble(reader, source, type_name)


def parse_idl_structures(source: SourceText) -> tuple[Structure, ...]:
    """Parse an ``.idl`` file that does not follow the layout of ROS interfaces.

    Returns:
        All structures and unions of the file with their full names, such as ``robot::State``, then a structure without
        fields for each enumeration, and for each module that only has constants. The types of fields are not checked.

    Raises:
        DefinitionError: MSG114, MSG119 or MSG120, for text that cannot be parsed.
    """
    reader = _Reader(source, None)
    reader.read_definitions(())
    fields, constants = reader.structures, reader.constants
    return tuple(
        Structure(name.replace("/", "::"), tuple(fields.get(name, ())), tuple(constants.get(name, ())))
        for name in dict.fromkeys([*fields, *constants])
    )


def _assemble(reader: _Reader, source: SourceText, type_name: str) -> Definition:
    _, kind, _ = type_name.split("/")
    structures: list[Structure] = []
    for suffix in SECTIONS[kind]:
        name = type_name + suffix
        if name not in reader.structures:
            hint = did_you_mean(name, reader.structures)
            message = phrase("the file does not define the structure '{name}'", name=name.replace("/", "::"))
            raise DefinitionError(Diagnostic("MSG118", message, source.span(0), hint=hint, source=source))
        fields = tuple(field for field in reader.structures[name] if field.name != EMPTY_MEMBER)
        structures.append(Structure(name, fields, tuple(reader.constants.get(name, ()))))
    return build_interface(type_name, structures)


class _Reader:
    """A parser that converts the tokens of one file to structures and constants.

    Args:
        source: the content of the file.
        known_messages: determines which messages exist; None to accept any type.
    """

    def __init__(self, source: SourceText, known_messages: KnownMessages | None) -> None:
        self._source = source
        self._known = known_messages
        self._tokens = list(self._tokenize())
        self._at = 0
        self._typedefs: dict[str, FieldType] = {}
        self.structures: dict[str, list[Field]] = {}
        self.constants: dict[str, list[Constant]] = {}

    def _tokenize(self) -> Iterator[_Token]:
        text, position = self._source.text, 0
        while position < len(text):
            match = _TOKEN_PATTERN.match(text, position)
            if match is None:
                self._fail("MSG120", phrase("unexpected '{text}'", text=text[position]), position, 1)
            assert match.lastgroup is not None
            if match.lastgroup != "skip":
                yield _Token(match.lastgroup, match.group(), position)
            position = match.end()
        yield _Token("end", "", position)

    # --- definitions ----------------------------------------------------------------------------------------

    def read_definitions(self, scope: tuple[str, ...]) -> None:
        """Parse the content of a module, or of the file."""
        while self._current_token.kind != "end" and self._current_token.text != "}":
            self._read_annotations()
            keyword = self._expect_name()
            if keyword.text == "module":
                name = self._expect_name().text
                self._expect("{")
                self.read_definitions((*scope, name))
                self._expect("}")
                self._expect(";")
            elif keyword.text == "struct":
                self._read_structure(scope)
            elif keyword.text == "typedef":
                kind = self._read_type()
                name, kind = self._parse_declarator(kind)
                self._typedefs[name] = kind
                self._expect(";")
            elif keyword.text == "const":
                self._read_constant(scope)
            elif keyword.text == "enum" and self._known is None:
                self._read_enumeration(scope)
            elif keyword.text == "union" and self._known is None:
                self._read_union(scope)
            else:
                self._fail(
                    "MSG120",
                    phrase("'{construct}' is not supported in messages", construct=keyword.text),
                    keyword.start,
                    len(keyword.text),
                    phrase("write the interface as a .msg, .srv or .action file"),
                )

    def _read_structure(self, scope: tuple[str, ...]) -> None:
        name = "/".join((*scope, self._expect_name().text))
        fields: list[Field] = []
        self._expect("{")
        while self._current_token.text != "}":
            default = self._read_annotations()
            kind = self._read_type()
            while True:
                field_name, field_type = self._parse_declarator(kind)
                fields.append(Field(field_name, field_type, self._parse_default(default, field_type)))
                if self._current_token.text != ",":
                    break
                self._expect(",")
            self._expect(";")
        self._expect("}")
        self._expect(";")
        self.structures[name] = fields

    def _read_enumeration(self, scope: tuple[str, ...]) -> None:
        """Parse an enumeration. Its values are constants of the type `ENUMERATION`."""
        name = "/".join((*scope, self._expect_name().text))
        values: list[Constant] = []
        number = 0
        self._expect("{")
        while self._current_token.text != "}":
            start = self._at
            self._read_annotations()
            given = [token.text for token in self._tokens[start : self._at] if token.text.isdigit()]
            number = int(given[-1]) if given else number
            values.append(Constant(self._expect_name().text, ENUMERATION, number))
            number += 1
            if self._current_token.text != "}":
                self._expect(",")
        self._expect("}")
        self._expect(";")
        self.constants[name] = values

    def _read_union(self, scope: tuple[str, ...]) -> None:
        """Parse a union. Its fields are the discriminator and the members, independent of their cases."""
        name = "/".join((*scope, self._expect_name().text))
        self._expect("switch")
        self._expect("(")
        fields = [Field("switch", self._read_type(), None)]
        self._expect(")")
        self._expect("{")
        while self._current_token.text != "}":
            while self._current_token.text in ("case", "default"):
                if self._read_token().text == "case":
                    self._read_value()
                self._expect(":")
            self._read_annotations()
            field_name, field_type = self._parse_declarator(self._read_type())
            fields.append(Field(field_name, field_type, None))
            self._expect(";")
        self._expect("}")
        self._expect(";")
        self.structures[name] = fields

    def _read_constant(self, scope: tuple[str, ...]) -> None:
        kind = self._read_type()
        name = self._expect_name().text
        self._expect("=")
        value = self._read_value()
        self._expect(";")
        owner = "/".join(scope).removesuffix("_Constants")
        if kind.primitive is None or kind.container is not Container.ONE:
            self._fail(
                "MSG114",
                phrase("the constant '{name}' does not have a primitive type", name=name),
                value.start,
                len(value.text),
            )
        try:
            constant = Constant(name, kind.base, read_constant(_format_literal(value), kind.base))
        except LiteralError as fault:
            self._fail(
                "MSG114",
                phrase("the value of '{name}' is invalid: {fault}", name=name, fault=fault),
                value.start,
                len(value.text),
            )
        self.constants.setdefault(owner, []).append(constant)

    def _read_annotations(self) -> _Token | None:
        """Skip annotations, and return the value of ``@default (value=...)``, or None."""
        default = None
        while self._current_token.text == "@":
            self._expect("@")
            name = self._expect_name().text
            if self._current_token.text != "(":
                continue
            self._expect("(")
            depth = 1
            while depth:
                token = self._read_token()
                if token.kind == "end":
                    self._fail("MSG120", phrase("the file ends inside an annotation"), token.start, 0)
                depth += {"(": 1, ")": -1}.get(token.text, 0)
                if name == "default" and token.text == "=":
                    default = self._current_token
        return default

    def _parse_default(self, token: _Token | None, kind: FieldType) -> object | None:
        if token is None:
            return None
        text = _format_literal(token)
        if kind.container is not Container.ONE:
            # rosidl writes the default of a list as a string: "(1, 2, 3)".
            content = text[1:-1] if text[:1] in {'"', "'"} else text
            text = "[" + content.strip().removeprefix("(").removesuffix(")") + "]"
        try:
            return read_default(text, kind)
        except LiteralError as fault:
            self._fail(
                "MSG114", phrase("the default value is invalid: {fault}", fault=fault), token.start, len(token.text)
            )

    # --- types ----------------------------------------------------------------------------------------------

    def _read_type(self) -> FieldType:
        token = self._expect_name()
        keywords = [token.text]
        while keywords[-1] in _PRIMITIVE_KEYWORDS and self._current_token.text in _PRIMITIVE_KEYWORDS:
            keywords.append(self._expect_name().text)
        text = " ".join(keywords)
        if text in _PRIMITIVES:
            return FieldType(_PRIMITIVES[text])
        if text in {"string", "wstring"}:
            return FieldType(text, self._read_bound() if self._current_token.text == "<" else None)
        if text == "sequence":
            return self._read_sequence(token)
        if text in self._typedefs:
            return self._typedefs[text]
        if text in _UNSUPPORTED_TYPES:
            self._fail(
                "MSG120", phrase("'{construct}' is not supported in messages", construct=text), token.start, len(text)
            )
        if self._known is None:
            return FieldType(text)
        parts = text.split("::")
        if len(parts) != 3:
            self._fail("MSG111", phrase("there is no type '{text}'", text=text), token.start, len(text),
                       did_you_mean(text, [*_PRIMITIVES, "string", "sequence", *self._typedefs]))  # fmt: skip
        name = "/".join(parts)
        if name not in self.structures and not self._known.has_message(name):
            hint = self._known.find_hint(name)
            self._fail("MSG111", phrase("there is no message '{name}'", name=name), token.start, len(text), hint)
        return FieldType(name)

    def _read_sequence(self, token: _Token) -> FieldType:
        self._expect("<")
        item_type = self._read_type()
        size = None
        if self._current_token.text == ",":
            self._expect(",")
            size = self._read_size()
        self._expect(">")
        if item_type.container is not Container.ONE:
            self._fail(
                "MSG120", phrase("sequences of sequences and arrays are not supported in messages"), token.start, 8
            )
        return FieldType(item_type.base, item_type.string_bound, Container.SEQUENCE, size)

    def _parse_declarator(self, kind: FieldType) -> tuple[str, FieldType]:
        """Parse a declarator, and return its name and its type.

        The type includes an array size that follows the name.
        """
        token = self._expect_name()
        if self._current_token.text != "[":
            return token.text, kind
        self._expect("[")
        size = self._read_size()
        self._expect("]")
        if kind.container is not Container.ONE or self._current_token.text == "[":
            self._fail("MSG120", phrase("arrays of arrays and sequences are not supported in messages"), token.start,
                       len(token.text))  # fmt: skip
        return token.text, FieldType(kind.base, kind.string_bound, Container.ARRAY, size)

    def _read_bound(self) -> int:
        self._expect("<")
        bound = self._read_size()
        self._expect(">")
        return bound

    def _read_size(self) -> int:
        token = self._read_token()
        if not token.text.isdigit() or int(token.text) == 0:
            self._fail(
                "MSG119",
                phrase("'{value}' is not a length: write an integer above 0", value=token.text),
                token.start,
                len(token.text),
            )
        return int(token.text)

    # --- tokens ---------------------------------------------------------------------------------------------

    @property
    def _current_token(self) -> _Token:
        return self._tokens[self._at]

    def _read_token(self) -> _Token:
        token = self._tokens[self._at]
        if token.kind != "end":
            self._at += 1
        return token

    def _expect_name(self) -> _Token:
        token = self._read_token()
        if token.kind != "name":
            self._unexpected_token_error(token, phrase("a name"))
        return token

    def _read_value(self) -> _Token:
        token = self._read_token()
        if token.kind not in {"number", "text", "name"}:
            self._unexpected_token_error(token, phrase("a value"))
        return token

    def _expect(self, mark: str) -> None:
        token = self._read_token()
        if token.text != mark:
            self._unexpected_token_error(token, quoted(mark))

    def _unexpected_token_error(self, token: _Token, expected: Phrase) -> NoReturn:
        actual = quoted(token.text) if token.text else phrase("the end of the file")
        self._fail(
            "MSG120",
            phrase("expected {expected}, but found {actual}", actual=actual, expected=expected),
            token.start,
            len(token.text),
        )

    def _fail(self, code: str, message: Phrase, start: int, length: int, hint: Phrase | None = None) -> NoReturn:
        span = self._source.span(start, start + length)
        raise DefinitionError(Diagnostic(code, message, span, hint=hint, source=self._source))


def _format_literal(token: _Token) -> str:
    """Return the text of a literal as a ``.msg`` file would contain it."""
    if token.kind == "text":
        return token.text.removeprefix("L")
    if token.kind == "number" and not token.text.lower().startswith(("0x", "-0x")):
        return token.text.rstrip("dDfF")
    return token.text
