"""Compile the functions that deserialize structures from CDR.

Such a function unpacks each run of fields of fixed size, including fields of nested structures, with one `struct` call
directly into the slots of the objects. The checks on assignment are skipped. The function does not trust lengths in the
data: no length can make it read or allocate more than the data contains. `linkwright.messages.cdr.values.READ_FAULTS`
lists all errors that it raises for bad data.
"""

from __future__ import annotations

import struct
from array import array
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from typing import Any, Literal

from linkwright.messages.cdr import values as cdr_values
from linkwright.messages.cdr.layout import (
    ANYWHERE,
    MAX_INLINE_LEAVES,
    MAX_LOOP_DEPTH,
    START,
    Alignment,
    get_layout_facts,
)
from linkwright.messages.definitions.interfaces import Container, Field, FieldType, Primitive, Structure
from linkwright.messages.definitions.library import LIBRARY

_SCOPE: dict[str, Any] = {
    "new": object.__new__,
    "texts": cdr_values.read_texts,
    "numbers": cdr_values.read_numbers,
    "bools": cdr_values.read_bools,
    "single_bytes": cdr_values.read_bytes,
    "wide": cdr_values.read_wide_text,
    "raise_truncated": cdr_values.raise_truncated,
    "raise_unterminated": cdr_values.raise_unterminated,
    "raise_bad_bool": cdr_values.raise_bad_bool,
    "raise_too_long": cdr_values.raise_too_long,
    "check_bounds": cdr_values.check_bounds,
    "array": array,
}

_part_readers: dict[tuple[str, str], Callable[..., Any]] = {}

ClassOf = Callable[[Structure], type]
Order = Literal["<", ">"]


def compile_reader(structure: Structure, class_of: ClassOf, order: Order = "<") -> Callable[[bytes], Any]:
    """Return a new function that creates a message from its bytes, including the header.

    Args:
        structure: the structure to read.
        class_of: returns the class of a structure.
        order: ``<`` for little-endian data, ``>`` for big-endian data.
    """
    code = _ReaderCode(START, class_of, order, known_position=4)
    name = code.add_creation(structure)
    code.structure(structure, name)
    code.end_run()
    body = "    e = len(d)\n" + code.body()
    reader: Callable[[bytes], Any] = code.compile_function(f"def read(d):\n{body}    return {name}\n", structure)
    return reader


def _compile_part(structure: Structure, class_of: ClassOf, order: Order) -> Callable[..., Any]:
    """Return the function that reads a nested structure at an offset.

    The function is compiled on first use. It returns the object and the offset after it.
    """
    reader = _part_readers.get((structure.type_name, order))
    if reader is None:
        code = _ReaderCode(ANYWHERE, class_of, order, known_position=None)
        name = code.add_creation(structure)
        code.structure(structure, name)
        code.end_run()
        source = f"def read(d, p, e):\n{code.body()}    return {name}, p\n"
        reader = _part_readers[structure.type_name, order] = code.compile_function(source, structure)
    return reader


class _ReaderCode:
    """A generator of the code of a reader.

    In the code, `p` is the position in the data, including the header, and `e` is the end of the data.
    """

    def __init__(self, alignment: Alignment, class_of: ClassOf, order: Order, known_position: int | None) -> None:
        self.alignment = alignment
        self._known_position = known_position
        """The position as a number, or None once it differs between messages."""
        self._class_of = class_of
        self._order = order
        self._lines: list[str] = []
        self._depth = 1
        self._loops = 0
        self._run: list[tuple[str, str]] = []
        self._after_run: list[str] = []
        self._names = count(1)
        self._scope = dict(_SCOPE)

    def body(self) -> str:
        return "".join(self._lines)

    def compile_function(self, source: str, structure: Structure) -> Any:
        exec(compile(source, f"<CDR reader of {structure.type_name}>", "exec"), self._scope)  # noqa: S102 - our own code
        return self._scope["read"]

    # --- structures and fields ------------------------------------------------------------------------------

    def add_creation(self, structure: Structure) -> str:
        """Generate code that creates a structure's object, and return its variable's name."""
        name = f"m{next(self._names)}"
        self._add_line(f"{name} = new({self._name_constant(self._class_of(structure), 'C')})")
        return name

    def structure(self, structure: Structure, target: str) -> None:
        if not structure.fields:
            self._read_primitive("B", 1, "_")
        for field in structure.fields:
            self._read_field(field, f"{target}._{field.name}")

    def _read_field(self, field: Field, target: str) -> None:
        kind = field.type
        if kind.container is Container.ONE:
            self._read_single(field.name, kind, target)
        elif kind.container is Container.ARRAY:
            self._read_array(field, target)
        else:
            self._read_sequence(field, target)

    def _read_single(self, name: str, kind: FieldType, target: str) -> None:
        primitive = kind.primitive
        if primitive is None:
            self._read_nested(kind, target)
        elif primitive.python is str:
            self._read_text(name, kind, target)
        elif primitive.python is bool:
            value = f"b{next(self._names)}"
            self._read_primitive("B", 1, value)
            self._after_run += [f"if {value} > 1: raise_bad_bool({value})", f"{target} = {value} == 1"]
        else:
            assert primitive.code is not None
            self._read_primitive(primitive.code, primitive.size, target)

    def _read_nested(self, kind: FieldType, target: str) -> None:
        structure = LIBRARY.structure(kind.base)
        if get_layout_facts(structure).leaf_count > MAX_INLINE_LEAVES or self._loops >= MAX_LOOP_DEPTH:
            self._write_position()
            part = _compile_part(structure, self._class_of, self._order)
            self._add_line(f"{target}, p = {self._name_constant(part, 'R')}(d, p, e)")
            self.alignment = ANYWHERE
        else:
            name = self.add_creation(structure)
            self._add_line(f"{target} = {name}")
            self.structure(structure, name)

    def _read_text(self, name: str, kind: FieldType, target: str) -> None:
        length = self._read_length()
        if kind.base == "wstring":
            self._add_line(f"{target}, p = wide(d, p, {length}, {self._order!r})")
            self.alignment = Alignment(4, 0)
        else:
            self._add_line(f"if {length}:")
            self._add_line(f"    q = p + {length} - 1")
            self._add_line("    if d[q]: raise_unterminated()")
            self._add_line(f"    {target} = str(d[p:q], 'utf-8')")
            self._add_line("    p = q + 1")
            self._add_line(f"else: {target} = ''")
            self.alignment = ANYWHERE
        if kind.string_bound is not None:
            self._add_line(f"if len({target}) > {kind.string_bound}: raise_too_long({name!r}, {kind.string_bound})")

    def _read_array(self, field: Field, target: str) -> None:
        kind, primitive, size = field.type, field.type.primitive, field.type.size
        assert size is not None
        if kind.is_numeric_array:
            assert primitive is not None
            self._align(primitive.size)
            self.end_run()
            import numpy as np

            dtype = np.dtype(primitive.dtype).newbyteorder(self._order)
            function, element = self._name_constant(np.frombuffer, "F"), self._name_constant(dtype, "T")
            data = f"{function}(d, {element}, {size}, {self._make_position_expression()})"
            native = f".astype({primitive.dtype!r})" if self._order == ">" else ".copy()"
            self._add_line(f"{target} = {data}{native}")
            self._skip(size * primitive.size)
        elif primitive is not None and primitive.python in (bool, bytes):
            self._write_position()
            self._read_small_values(primitive, str(size), target)
        else:
            self._read_repeated(field, target, str(size))

    def _read_sequence(self, field: Field, target: str) -> None:
        kind, primitive = field.type, field.type.primitive
        length = self._read_length()
        if kind.size is not None:
            self._add_line(f"if {length} > {kind.size}: raise_too_long({field.name!r}, {kind.size})")
        if kind.is_numeric_array:
            assert primitive is not None
            self._read_numbers(primitive, length, target)
        elif primitive is not None and primitive.python in (bool, bytes):
            self._read_small_values(primitive, length, target)
        elif kind.base == "string" and self._order == "<":
            self._add_line(f"{target}, p = texts(d, p, {length})")
            self.alignment = ANYWHERE
            if kind.string_bound is not None:
                self._add_line(f"check_bounds({field.name!r}, {target}, {kind.string_bound})")
        else:
            min_size = 4 if primitive is not None else get_layout_facts(LIBRARY.structure(kind.base)).min_size
            self._add_line(f"if {length} * {min_size} > e - p: raise_truncated()")
            self._read_repeated(field, target, length)

    def _read_numbers(self, primitive: Primitive, length: str, target: str) -> None:
        code = primitive.array_code
        self._add_line(f"if {length}:")
        self._depth += 1
        if primitive.size == 8:
            padding = self.alignment.padding(8)
            if padding is None:
                self._add_line("p = (p + 3 & -8) + 4")
            elif padding:
                self._add_line(f"p += {padding}")
        self._add_line(f"q = p + {length}" + (f" * {primitive.size}" if primitive.size > 1 else ""))
        self._add_line(f"{target} = numbers({code!r}, d, p, q)")
        if self._order == ">" and primitive.size > 1:
            self._add_line(f"{target}.byteswap()")
        self._add_line("p = q")
        self._depth -= 1
        self._add_line(f"else: {target} = array({code!r})")
        self.alignment = Alignment(min(primitive.size, 4), 0)

    def _read_small_values(self, primitive: Primitive, length: str, target: str) -> None:
        reader = "bools" if primitive.python is bool else "single_bytes"
        self._add_line(f"q = p + {length}")
        self._add_line(f"{target} = {reader}(d, p, q)")
        self._add_line("p = q")
        self.alignment = ANYWHERE

    def _read_repeated(self, field: Field, target: str, length: str) -> None:
        """Generate a loop over the values of a field.

        The code at the start of the loop assumes only an alignment that holds in every iteration.
        """
        item_type = FieldType(field.type.base, field.type.string_bound)
        self._write_position()
        values, value = f"l{next(self._names)}", f"x{next(self._names)}"
        self._add_line(f"{target} = {values} = []")
        start_alignment = self.alignment
        while True:
            line_count = len(self._lines)
            self.alignment = start_alignment
            with self._loop(length):
                self._read_single(field.name, item_type, value)
                self._write_position()
                self._add_line(f"{values}.append({value})")
            common_alignment = start_alignment.combine(self.alignment)
            if common_alignment == start_alignment:
                break
            start_alignment = common_alignment
            del self._lines[line_count:]
        self.alignment = start_alignment

    # --- positions and runs ---------------------------------------------------------------------------------

    def _read_length(self) -> str:
        """Generate code that reads the length of a string or sequence.

        Return the name of the length's variable.

        After this code, `p` is the position after the length.
        """
        name = f"n{next(self._names)}"
        self._read_primitive("I", 4, name)
        self._write_position()
        return name

    def _read_primitive(self, code: str, size: int, target: str) -> None:
        self._align(size)
        self._run.append((code, target))
        self.alignment = self.alignment.advance(size)

    def _align(self, size: int) -> None:
        padding = self.alignment.padding(size)
        if padding is None:
            self.end_run()
            self._add_line({2: "p += p & 1", 4: "p += -p & 3", 8: "p = (p + 3 & -8) + 4"}[size])
            self.alignment = Alignment(size, 0)
        elif padding:
            if self._run:
                self._run.append((f"{padding}x", ""))
            else:
                self._skip_bytes(padding)
            self.alignment = self.alignment.advance(padding)

    def end_run(self) -> None:
        """Generate the code that unpacks the fields of the current run, and start a new run."""
        if not self._run:
            return
        run_struct = struct.Struct(self._order + "".join(code for code, _ in self._run))
        targets = ", ".join(target for _, target in self._run if target)
        comma = "" if "," in targets else ","
        unpack = self._name_constant(run_struct.unpack_from, "U")
        self._add_line(f"{targets}{comma} = {unpack}(d, {self._make_position_expression()})")
        self._skip_bytes(run_struct.size)
        self._run = []
        for line in self._after_run:
            self._add_line(line)
        self._after_run = []

    def _skip(self, size: int) -> None:
        self._skip_bytes(size)
        self.alignment = self.alignment.advance(size)

    def _skip_bytes(self, size: int) -> None:
        if self._known_position is None:
            self._add_line(f"p += {size}")
        else:
            self._known_position += size

    def _make_position_expression(self) -> str:
        return "p" if self._known_position is None else str(self._known_position)

    def _write_position(self) -> None:
        """End the run, and store the position in `p`.

        The following code uses `p`.
        """
        self.end_run()
        if self._known_position is not None:
            self._add_line(f"p = {self._known_position}")
            self._known_position = None

    # --- lines and names ------------------------------------------------------------------------------------

    def _add_line(self, text: str) -> None:
        self._lines.append("    " * self._depth + text + "\n")

    def _name_constant(self, value: Any, letter: str) -> str:
        name = f"{letter}{len(self._scope)}"
        self._scope[name] = value
        return name

    @contextmanager
    def _loop(self, length: str) -> Iterator[None]:
        self._add_line(f"for _ in range({length}):")
        self._depth += 1
        self._loops += 1
        yield
        self._depth -= 1
        self._loops -= 1
