"""Compiles the functions that serialize structures to CDR.

Such a function packs runs of fixed fields, including those of nested structures, with one `struct` call each, takes
encoded strings from a cache, uses arrays without copying them, and joins all parts at the end. Nothing is copied twice.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from typing import Any

from linkwright.messages.cdr import values as cdr_values
from linkwright.messages.cdr.layout import ANYWHERE, DEEPEST_LOOP, MOST_INLINE, START, Place, facts, field_facts
from linkwright.messages.definitions.interfaces import EMPTY_MEMBER, Container, Field, FieldType, Primitive, Structure
from linkwright.messages.definitions.library import LIBRARY

_HEADER = 0x100
"""The four bytes before a message, 00 01 00 00, as a little-endian number."""


class LengthFaultError(ValueError):
    """Raised when a field has more or fewer values than its definition allows."""


def _check_length(name: str, value: Any, size: int) -> None:
    if len(value) != size:
        raise LengthFaultError(f"'{name}' has {len(value)} values instead of {size}")


def _check_bound(name: str, value: Any, size: int) -> None:
    if len(value) > size:
        raise LengthFaultError(f"'{name}' has a length of {len(value)}, more than its bound of {size}")


_SCOPE: dict[str, Any] = {
    "TEXT1": cdr_values.TEXT1,
    "TEXT4": cdr_values.TEXT4,
    "LIST1": cdr_values.TEXT_LIST1,
    "LIST4": cdr_values.TEXT_LIST4,
    "wide": cdr_values.write_wide_text,
    "join": b"".join,
    "PAD": tuple(bytes(count) for count in range(8)),
    "check_length": _check_length,
    "check_bound": _check_bound,
}

_parts: dict[str, Callable[..., int]] = {}


def compile_writer(structure: Structure) -> Callable[[Any], bytes]:
    """Compile the function that serializes a message, including the header, to bytes."""
    code = _WriterCode(START)
    code.pack("I", str(_HEADER), place=START)
    code.structure(structure, "m", 0)
    result = code.result()
    writer: Callable[[Any], bytes] = code.compiled(f"def write(m):\n{code.body()}    return {result}\n", structure)
    return writer


def _compile_part(structure: Structure) -> Callable[..., int]:
    """Compile the function that serializes a nested structure.

    The function appends the bytes to a list of parts and returns the position of their end.
    """
    found = _parts.get(structure.type_name)
    if found is None:
        code = _WriterCode(ANYWHERE)
        code.structure(structure, "m", 0)
        code.flush()
        code.sync()
        code.needs_position = True
        body = code.body(start="")
        found = _parts[structure.type_name] = code.compiled(f"def write(o, m, p):\n{body}    return p\n", structure)
    return found


class _WriterCode:
    """Generates the code of a writer."""

    def __init__(self, place: Place) -> None:
        self.place = place
        self.needs_position = False
        self._lines: list[str] = []
        self._depth = 1
        self._loops = 0
        self._run: list[tuple[str, str]] = []
        self._pieces: list[str] = []
        self._unsynced: list[str] = []
        self._uses_list = False
        self._names = count(1)
        self._scope = dict(_SCOPE)

    # --- the frame of the function --------------------------------------------------------------------------

    def body(self, start: str = "    p = 0\n") -> str:
        lines = [line for line in self._lines if self.needs_position or not line.lstrip().startswith("p += ")]
        head = start if self.needs_position else ""
        if self._uses_list and start:
            head += "    o = []\n"
        return head + "".join(lines)

    def result(self) -> str:
        self._end_run()
        if self._uses_list:
            self.flush()
            return "join(o)"
        pieces = self._pieces
        return pieces[0] if len(pieces) == 1 and pieces[0].startswith("P") else f"join(({', '.join(pieces)},))"

    def compiled(self, source: str, structure: Structure) -> Any:
        exec(compile(source, f"<CDR writer of {structure.type_name}>", "exec"), self._scope)  # noqa: S102 - our own code
        return self._scope["write"]

    # --- structures and fields ------------------------------------------------------------------------------

    def structure(self, structure: Structure, source: str, following: int) -> None:
        """Generate the writing of a structure's fields.

        Args:
            structure: the structure to write.
            source: the expression for the structure.
            following: the alignment of the data after the structure; 0 if it is not known.
        """
        fields = structure.wire_fields
        for number, field in enumerate(fields):
            after = field_facts(fields[number + 1]).first if number + 1 < len(fields) else following
            value = "0" if field.name == EMPTY_MEMBER else f"{source}._{field.name}"
            self._field(field, value, after)

    def _field(self, field: Field, value: str, following: int) -> None:
        kind = field.type
        if kind.container is Container.ONE:
            self._one(field.name, kind, value, following)
            return
        if kind.is_numeric_array:
            self._numbers(field, value)
            return
        values = self._named(value)
        if kind.container is Container.ARRAY:
            self._line(f"check_length({field.name!r}, {values}, {kind.size})")
        else:
            if kind.size is not None:
                self._line(f"check_bound({field.name!r}, {values}, {kind.size})")
            if kind.base != "string":
                self.align(4)
                self.pack("I", f"len({values})")
        self._values(field, values, following)

    def _one(self, name: str, kind: FieldType, value: str, following: int) -> None:
        primitive = kind.primitive
        if primitive is None:
            self._nested(kind, value, following)
        elif primitive.python is str:
            if kind.string_bound is not None:
                self._line(f"check_bound({name!r}, {value}, {kind.string_bound})")
            self._text(kind, value, following)
        else:
            assert primitive.code is not None
            self.align(primitive.size)
            self.pack(primitive.code, value)

    def _text(self, kind: FieldType, value: str, following: int) -> None:
        self.align(4)
        if kind.base == "wstring":
            self._piece(self._named(f"wide({value})"), Place(4, 0))
        elif following >= 4:
            self._piece(self._named(f"TEXT4[{value}]"), Place(4, 0))
        else:
            self._piece(self._named(f"TEXT1[{value}]"), ANYWHERE)

    def _nested(self, kind: FieldType, value: str, following: int) -> None:
        structure = LIBRARY.structure(kind.base)
        if facts(structure).leaves > MOST_INLINE or self._loops >= DEEPEST_LOOP:
            self.flush()
            self.sync()
            self.needs_position = self._uses_list = True
            self._line(f"p = {self._given(_compile_part(structure), 'W')}(o, {value}, p)")
            self.place = ANYWHERE
        else:
            self.structure(structure, value if value.isidentifier() else self._named(value), following)

    def _numbers(self, field: Field, value: str) -> None:
        kind, primitive = field.type, field.type.primitive
        assert primitive is not None
        if kind.container is Container.ARRAY:
            assert kind.size is not None
            self.align(primitive.size)
            self._end_run()
            self._pieces.append(f"{value}.tobytes()")
            self._advance(kind.size * primitive.size)
            return
        values = self._named(value)
        if kind.size is not None:
            self._line(f"check_bound({field.name!r}, {values}, {kind.size})")
        length = self._named(f"len({values})")
        self.align(4)
        self.pack("I", length)
        self._end_run()
        if primitive.size == 8:
            # No padding follows the length of an empty sequence.
            if self.place.padding(8) is None:
                self.sync()
                self.needs_position = True
                padding = self._named(f"-p & 4 if {length} else 0")
            else:
                padding = self._named(f"{self.place.padding(8)} if {length} else 0")
            self._pieces.append(f"PAD[{padding}]")
            self._unsynced.append(padding)
        self._pieces.append(values)
        self._unsynced.append(f"{primitive.size} * {length}" if primitive.size > 1 else length)
        self.place = Place(min(primitive.size, 4), 0)

    def _values(self, field: Field, values: str, following: int) -> None:
        kind, primitive = field.type, field.type.primitive
        if primitive is not None and primitive.python in (bool, bytes):
            self._small_values(primitive, values)
        elif kind.base == "string" and kind.container is Container.SEQUENCE:
            if kind.string_bound is not None:
                with self._loop("e", values) as item:
                    self._line(f"check_bound({field.name!r}, {item}, {kind.string_bound})")
            self.align(4)
            pieces, place = ("LIST4", Place(4, 0)) if following >= 4 else ("LIST1", ANYWHERE)
            self._piece(self._named(f"{pieces}[tuple({values})]"), place)
        else:
            one = FieldType(kind.base, kind.string_bound)
            self._repeated(values, lambda item: self._one(field.name, one, item, 0))

    def _small_values(self, primitive: Primitive, values: str) -> None:
        piece = f"bytes(map(bool, {values}))" if primitive.python is bool else f"join({values})"
        self._piece(self._named(piece), ANYWHERE)

    def _repeated(self, values: str, write: Callable[[str], None]) -> None:
        """Generate a loop over values.

        At the start of the loop, the code relies only on an alignment that holds in every iteration.
        """
        self.flush()
        self.sync()
        before = self.place
        while True:
            lines, unsynced, names = len(self._lines), list(self._unsynced), self._names
            self.place = before
            with self._loop("e", values) as item:
                write(item)
                self.flush()
                self.sync()
            met = before.met(self.place)
            if met == before:
                break
            before = met
            del self._lines[lines:]
            self._unsynced, self._names = unsynced, names
        self.place = before

    # --- pieces ---------------------------------------------------------------------------------------------

    def align(self, size: int) -> None:
        """Generate the padding up to a multiple of `size`."""
        padding = self.place.padding(size)
        if padding is None:
            self._end_run()
            self.sync()
            self.needs_position = True
            amount = self._named(f"-p & {size - 1}")
            self._pieces.append(f"PAD[{amount}]")
            self._unsynced.append(amount)
            self.place = Place(size, 0)
        elif padding:
            self._run.append((f"{padding}x", ""))
            self._advance(padding)

    def pack(self, code: str, value: str, place: Place | None = None) -> None:
        """Generate the packing of a primitive at an aligned position.

        If `place` is given, the position does not advance.
        """
        self._run.append((code, value))
        if place is None:
            self._advance(struct.calcsize("<" + code))

    def flush(self) -> None:
        """Generate the code that appends the collected fields to the list of parts."""
        self._end_run()
        if self._pieces:
            self._uses_list = True
            self._line(f"o += ({', '.join(self._pieces)},)")
            self._pieces = []

    def sync(self) -> None:
        """Generate the code that sets the variable `p` to the current position."""
        if self._unsynced:
            numbers = sum(int(term) for term in self._unsynced if term.isdigit())
            terms = [term for term in self._unsynced if not term.isdigit()]
            self._line("p += " + " + ".join(terms + ([str(numbers)] if numbers else [])))
            self._unsynced = []

    def _piece(self, name: str, place: Place) -> None:
        self._end_run()
        self._pieces.append(name)
        self._unsynced.append(f"len({name})")
        self.place = place

    def _end_run(self) -> None:
        if self._run:
            codes = "".join(code for code, _ in self._run)
            values = ", ".join(value for _, value in self._run if value)
            pack = struct.Struct("<" + codes).pack
            self._pieces.append(f"{self._given(pack, 'P')}({values})")
            self._run = []

    def _advance(self, size: int) -> None:
        self._unsynced.append(str(size))
        self.place = self.place.after(size)

    # --- lines and names ------------------------------------------------------------------------------------

    def _line(self, text: str) -> None:
        self._lines.append("    " * self._depth + text + "\n")

    def _named(self, expression: str) -> str:
        name = f"v{next(self._names)}"
        self._line(f"{name} = {expression}")
        return name

    def _given(self, value: Any, letter: str) -> str:
        name = f"{letter}{len(self._scope)}"
        self._scope[name] = value
        return name

    @contextmanager
    def _loop(self, letter: str, values: str) -> Iterator[str]:
        name = f"{letter}{next(self._names)}"
        self._line(f"for {name} in {values}:")
        self._depth += 1
        self._loops += 1
        lines = len(self._lines)
        yield name
        if len(self._lines) == lines:
            self._line("pass")
        self._depth -= 1
        self._loops -= 1
