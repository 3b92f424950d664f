"""The types that fields are made of in the end, and what each is called in Python, in numpy, in IDL and on the wire."""

from __future__ import annotations

from typing import NamedTuple


class Primitive(NamedTuple):
    """One primitive type.

    Attributes:
        idl_name: what rosidl calls it, as `get_fields_and_field_types` shows.
        python: the type that a value must have.
        code: of `struct` for one value; None for text.
        size: bytes on the wire, which is the alignment too; of text, those of its length.
        type_id: in the type descriptions of REP 2016, whose hash is sent with endpoints.
        array_code: of `array.array`; None where rclpy holds several values in a list.
        low: the least value of an integer type.
        high: the greatest value of an integer type; the greatest finite one of a floating point type.
    """

    idl_name: str
    python: type
    code: str | None
    size: int
    type_id: int
    array_code: str | None = None
    low: int = 0
    high: int | float = 0

    @property
    def is_integer(self) -> bool:
        """Whether values are whole numbers; bytes and bools are not counted as such."""
        return self.python is int

    @property
    def dtype(self) -> str:
        """The name of numpy's type, for those with an array code."""
        return {"float": "float32", "double": "float64"}.get(self.idl_name, self.idl_name)


def _integer(name: str, code: str, bits: int, type_id: int, *, signed: bool) -> Primitive:
    low, high = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)
    return Primitive(name, int, code, bits // 8, type_id, code, low, high)


PRIMITIVES: dict[str, Primitive] = {
    "int8": _integer("int8", "b", 8, 2, signed=True),
    "uint8": _integer("uint8", "B", 8, 3, signed=False),
    # In .msg files char has meant an unsigned byte since ROS 1, and rosidl turns it into one.
    "char": _integer("uint8", "B", 8, 3, signed=False),
    "int16": _integer("int16", "h", 16, 4, signed=True),
    "uint16": _integer("uint16", "H", 16, 5, signed=False),
    "int32": _integer("int32", "i", 32, 6, signed=True),
    "uint32": _integer("uint32", "I", 32, 7, signed=False),
    "int64": _integer("int64", "q", 64, 8, signed=True),
    "uint64": _integer("uint64", "Q", 64, 9, signed=False),
    "float32": Primitive("float", float, "f", 4, 10, "f", 0, 3.402823466e38),
    "float64": Primitive("double", float, "d", 8, 11, "d", 0, 1.7976931348623157e308),
    "bool": Primitive("boolean", bool, "B", 1, 15),
    "byte": Primitive("octet", bytes, "c", 1, 16),
    "string": Primitive("string", str, None, 4, 17),
    "wstring": Primitive("wstring", str, None, 4, 18),
}
"""By the name in ``.msg`` files."""
