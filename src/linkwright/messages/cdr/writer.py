"""Compile the functions that serialize structures to CDR.

Such a function packs each run of fields of fixed size, including fields of nested structures, with one `struct` call.
It takes encoded strings from a cache, uses arrays without copying them, and joins all pieces at the end.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from typing import Any

from linkwright.messages.cdr import values as cdr_values
from linkwright.messages.cdr.layout import (
    ANYWHERE,
    MAX_INLINE_LEAVES,
    MAX_LOOP_DEPTH,
    START,
    Alignment,
    compute_field_facts,
    get_layout_facts,
)
from linkwright.messages.definitions.interfaces import EMPTY_MEMBER, Container, Field, FieldType, Primitive, Structure
from linkwright.messages.definitions.library import LIBRARY

_HEADER_BYTES = 0x100
"""The four header bytes of a message, 00 01 00 00, as a little-endian number."""


class LengthError(ValueError):
    """Raised when a field has more or fewer values than its definition allows."""


def _check_length(name: str, value: Any, size: int) -> None:
    if len(value) != size:
        raise LengthError(f"'{name}' has {len(value)} values instead of {size}")


def _check_bound(name: str, value: Any, size: int) -> None:
    if len(value) > size:
        raise LengthError(f"'{name}' has a length of {len(value)}, more than its bound of {size}")


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

_part_writers: dict[str, Callable[..., int]] = {}


def compile_writer(structure: Structure) -> Callable[[Any], bytes]:
    """Return a new function that serializes a message to bytes, including the header."""
    code = _WriterCode(START)
    code.pack("I", str(_HEADER_BYTES), alignment=START)
    code.structure(structure, "m", 0)
    result = code.result()
    writer: Callable[[Any], bytes] = code.compile_function(
        f"def write(m):\n{code.body()}    return {result}\n", structure
    )
    return writer


def _compile_part(structure: Structure) -> Callable[..., int]:
    """Return the function that serializes a nested structure, compiled on first use.

    The function appends the bytes to a list of pieces and returns the position after them.
    """
    writer = _part_writers.get(structure.type_name)
    if writer is None:
        code = _WriterCode(ANYWHERE)
        code.structure(structure, "m", 0)
        code.flush()
        code.sync()
        code.needs_position = True
        body = code.body(start="")
        writer = _part_writers[structure.type_name] = code.compile_function(
            f"def write(o, m, p):\n{body}    return p\n", structure
        )
    return writer


class _WriterCode:
    """A generator of the code of a writer.

    In the code, `p` is the position after the header, and `o` is the list of pieces.
    """

    def __init__(self, alignment: Alignment) -> None:
        self.alignment = alignment
        self.needs_position = False
        self._lines: list[str] = []
        self._depth = 1
        self._loops = 0
        self._run: list[tuple[str, str]] = []
        self._pieces: list[str] = []
        self._unsynced_sizes: list[str] = []
        self._uses_list = False
        self._names = count(1)
        self._scope = dict(_SCOPE)

    # --- the frame of the function --------------------------------------------------------------------------

    def body(self, start: str = "    p = 0\n") -> str:
        lines = [line for line in self._lines if self.needs_position or not line.lstrip().startswith("p += ")]
        setup = start if self.needs_position else ""
        if self._uses_list and start:
            setup += "    o = []\n"
        return setup + "".join(lines)

    def result(self) -> str:
        self._end_run()
        if self._uses_list:
            self.flush()
            return "join(o)"
        pieces = self._pieces
        return pieces[0] if len(pieces) == 1 and pieces[0].startswith("P") else f"join(({', '.join(pieces)},))"

    def compile_function(self, source: str, structure: Structure) -> Any:
        exec(compile(source, f"<CDR writer of {structure.type_name}>", "exec"), self._scope)  # noqa: S102 - our own code
        return self._scope["write"]

    # --- structures and fields ------------------------------------------------------------------------------

    def structure(self, structure: Structure, source: str, following_alignment: int) -> None:
        """Generate the code that writes a structure's fields.

        Args:
            structure: the structure to write.
            source: the Python expression for the structure.
            following_alignment: the alignment of the data after the structure in bytes; 0 if it is not known.
        """
        fields = structure.wire_fields
        for index, field in enumerate(fields):
            next_alignment = (
                compute_field_facts(fields[index + 1]).first_alignment
                if index + 1 < len(fields)
                else following_alignment
            )
            value = "0" if field.name == EMPTY_MEMBER else f"{source}._{field.name}"
            self._write_field(field, value, next_alignment)

    def _write_field(self, field: Field, value: str, following_alignment: int) -> None:
        kind = field.type
        if kind.container is Container.ONE:
            self._write_single(field.name, kind, value, following_alignment)
            return
        if kind.is_numeric_array:
            self._write_numbers(field, value)
            return
        values = self._assign_variable(value)
        if kind.container is Container.ARRAY:
            self._add_line(f"check_length({field.name!r}, {values}, {kind.size})")
        else:
            if kind.size is not None:
                self._add_line(f"check_bound({field.name!r}, {values}, {kind.size})")
            if kind.base != "string":
                self.align(4)
                self.pack("I", f"len({values})")
        self._write_values(field, values, following_alignment)

    def _write_single(self, name: str, kind: FieldType, value: str, following_alignment: int) -> None:
        primitive = kind.primitive
        if primitive is None:
            self._write_nested(kind, value, following_alignment)
        elif primitive.python is str:
            if kind.string_bound is not None:
                self._add_line(f"check_bound({name!r}, {value}, {kind.string_bound})")
            self._write_text(kind, value, following_alignment)
        else:
            assert primitive.code is not None
            self.align(primitive.size)
            self.pack(primitive.code, value)

    def _write_text(self, kind: FieldType, value: str, following_alignment: int) -> None:
        self.align(4)
        if kind.base == "wstring":
            self._add_piece(self._assign_variable(f"wide({value})"), Alignment(4, 0))
        elif following_alignment >= 4:
            self._add_piece(self._assign_variable(f"TEXT4[{value}]"), Alignment(4, 0))
        else:
            self._add_piece(self._assign_variable(f"TEXT1[{value}]"), ANYWHERE)

    def _write_nested(self, kind: FieldType, value: str, following_alignment: int) -> None:
        structure = LIBRARY.structure(kind.base)
        if get_layout_facts(structure).leaf_count > MAX_INLINE_LEAVES or self._loops >= MAX_LOOP_DEPTH:
            self.flush()
            self.sync()
            self.needs_position = self._uses_list = True
            self._add_line(f"p = {self._name_constant(_compile_part(structure), 'W')}(o, {value}, p)")
            self.alignment = ANYWHERE
        else:
            self.structure(
                structure, value if value.isidentifier() else self._assign_variable(value), following_alignment
            )

    def _write_numbers(self, field: Field, value: str) -> None:
        kind, primitive = field.type, field.type.primitive
        assert primitive is not None
        if kind.container is Container.ARRAY:
            assert kind.size is not None
            self.align(primitive.size)
            self._end_run()
            self._pieces.append(f"{value}.tobytes()")
            self._advance(kind.size * primitive.size)
            return
        values = self._assign_variable(value)
        if kind.size is not None:
            self._add_line(f"check_bound({field.name!r}, {values}, {kind.size})")
        length = self._assign_variable(f"len({values})")
        self.align(4)
        self.pack("I", length)
        self._end_run()
        if primitive.size == 8:
            # No padding follows the length of an empty sequence.
            if self.alignment.padding(8) is None:
                self.sync()
                self.needs_position = True
                padding = self._assign_variable(f"-p & 4 if {length} else 0")
            else:
                padding = self._assign_variable(f"{self.alignment.padding(8)} if {length} else 0")
            self._pieces.append(f"PAD[{padding}]")
            self._unsynced_sizes.append(padding)
        self._pieces.append(values)
        self._unsynced_sizes.append(f"{primitive.size} * {length}" if primitive.size > 1 else length)
        self.alignment = Alignment(min(primitive.size, 4), 0)

    def _write_values(self, field: Field, values: str, following_alignment: int) -> None:
        kind, primitive = field.type, field.type.primitive
        if primitive is not None and primitive.python in (bool, bytes):
            self._write_small_values(primitive, values)
        elif kind.base == "string" and kind.container is Container.SEQUENCE:
            if kind.string_bound is not None:
                with self._loop("e", values) as item:
                    self._add_line(f"check_bound({field.name!r}, {item}, {kind.string_bound})")
            self.align(4)
            cache_name, alignment = ("LIST4", Alignment(4, 0)) if following_alignment >= 4 else ("LIST1", ANYWHERE)
            self._add_piece(self._assign_variable(f"{cache_name}[tuple({values})]"), alignment)
        else:
            item_type = FieldType(kind.base, kind.string_bound)
            self._write_repeated(values, lambda item: self._write_single(field.name, item_type, item, 0))

    def _write_small_values(self, primitive: Primitive, values: str) -> None:
        piece = f"bytes(map(bool, {values}))" if primitive.python is bool else f"join({values})"
        self._add_piece(self._assign_variable(piece), ANYWHERE)

    def _write_repeated(self, values: str, write_item: Callable[[str], None]) -> None:
        """Generate a loop over values.

        The code at the start of the loop assumes only an alignment that holds in every iteration.
        """
        self.flush()
        self.sync()
        start_alignment = self.alignment
        while True:
            line_count, unsynced, names = len(self._lines), list(self._unsynced_sizes), self._names
            self.alignment = start_alignment
            with self._loop("e", values) as item:
                write_item(item)
                self.flush()
                self.sync()
            common_alignment = start_alignment.combine(self.alignment)
            if common_alignment == start_alignment:
                break
            start_alignment = common_alignment
            del self._lines[line_count:]
            self._unsynced_sizes, self._names = unsynced, names
        self.alignment = start_alignment

    # --- pieces ---------------------------------------------------------------------------------------------

    def align(self, size: int) -> None:
        """Generate the code that pads to a multiple of `size`."""
        padding = self.alignment.padding(size)
        if padding is None:
            self._end_run()
            self.sync()
            self.needs_position = True
            padding_name = self._assign_variable(f"-p & {size - 1}")
            self._pieces.append(f"PAD[{padding_name}]")
            self._unsynced_sizes.append(padding_name)
            self.alignment = Alignment(size, 0)
        elif padding:
            self._run.append((f"{padding}x", ""))
            self._advance(padding)

    def pack(self, code: str, value: str, alignment: Alignment | None = None) -> None:
        """Add a primitive to the current run.

        The position must be aligned. If `alignment` is not None, the position does not advance.
        """
        self._run.append((code, value))
        if alignment is None:
            self._advance(struct.calcsize("<" + code))

    def flush(self) -> None:
        """Generate the code that appends the collected pieces to the list."""
        self._end_run()
        if self._pieces:
            self._uses_list = True
            self._add_line(f"o += ({', '.join(self._pieces)},)")
            self._pieces = []

    def sync(self) -> None:
        """Generate the code that sets the variable `p` to the current position."""
        if self._unsynced_sizes:
            constant_size = sum(int(term) for term in self._unsynced_sizes if term.isdigit())
            terms = [term for term in self._unsynced_sizes if not term.isdigit()]
            self._add_line("p += " + " + ".join(terms + ([str(constant_size)] if constant_size else [])))
            self._unsynced_sizes = []

    def _add_piece(self, name: str, alignment: Alignment) -> None:
        self._end_run()
        self._pieces.append(name)
        self._unsynced_sizes.append(f"len({name})")
        self.alignment = alignment

    def _end_run(self) -> None:
        if self._run:
            codes = "".join(code for code, _ in self._run)
            values = ", ".join(value for _, value in self._run if value)
            pack = struct.Struct("<" + codes).pack
            self._pieces.append(f"{self._name_constant(pack, 'P')}({values})")
            self._run = []

    def _advance(self, size: int) -> None:
        self._unsynced_sizes.append(str(size))
        self.alignment = self.alignment.advance(size)

    # --- lines and names ------------------------------------------------------------------------------------

    def _add_line(self, text: str) -> None:
        self._lines.append("    " * self._depth + text + "\n")

    def _assign_variable(self, expression: str) -> str:
        name = f"v{next(self._names)}"
        self._add_line(f"{name} = {expression}")
        return name

    def _name_constant(self, value: Any, letter: str) -> str:
        name = f"{letter}{len(self._scope)}"
        self._scope[name] = value
        return name

    @contextmanager
    def _loop(self, letter: str, values: str) -> Iterator[str]:
        name = f"{letter}{next(self._names)}"
        self._add_line(f"for {name} in {values}:")
        self._depth += 1
        self._loops += 1
        line_count = len(self._lines)
        yield name
        if len(self._lines) == line_count:
            self._add_line("pass")
        self._depth -= 1
        self._loops -= 1
