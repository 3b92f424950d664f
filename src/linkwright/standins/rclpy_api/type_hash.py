"""Hashes of interface types, as in REP 2016 (rclpy ``type_hash``)."""

from __future__ import annotations

from typing import TypedDict

_HASH_SIZE = 32


class TypeHashDictionary(TypedDict):
    """A type hash as a dictionary: the version of the hashing rules, and the 32-byte hash."""

    version: int
    value: bytes


class TypeHash:
    """A type hash with the version of the hashing rules.

    The version -1 means that there is no hash.

    Raises:
        AssertionError: the value does not have 32 bytes.
    """

    __slots__ = ("_value", "_version")

    def __init__(self, version: int = -1, value: bytes = bytes(_HASH_SIZE)) -> None:
        self.version = version
        self.value = value

    @property
    def version(self) -> int:
        """The version of the hashing rules."""
        return self._version

    @version.setter
    def version(self, version: int) -> None:
        assert isinstance(version, int)
        self._version = version

    @property
    def value(self) -> bytes:
        """The 32 bytes of the hash."""
        return self._value

    @value.setter
    def value(self, value: bytes) -> None:
        assert isinstance(value, bytes)
        assert len(value) == _HASH_SIZE
        self._value = value

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TypeHash):
            return NotImplemented
        return (self._version, self._value) == (other._version, other._value)

    def __hash__(self) -> int:
        return hash((self._version, self._value))

    def __str__(self) -> str:
        if self._version <= 0 or self._version > 0xFF:
            return "INVALID"
        return f"RIHS{self._version:02}_{self._value.hex()}"
