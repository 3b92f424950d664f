"""Define what interfaces lost, and the places where sources use it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

WHOLE = "whole"
"""The part of a service or action that has the other parts."""
_SERVICE_PARTS = {"Request": "request ", "Response": "response "}
_ACTION_PARTS = {"Goal": "goal ", "Result": "result ", "Feedback": "feedback "}


@dataclass(frozen=True)
class LostInterface:
    """An interface that was removed or lost fields or constants.

    Attributes:
        package: the name of the package.
        kind: ``msg``, ``srv`` or ``action``.
        name: the name of the interface, such as ``SetBool``.
        names: the lost fields and constants by the part, such as ``request``, with a space; empty for a message.
        constants: the names of all constants of the old version.
        is_removed: whether the whole interface was removed or renamed.
        field_types: by the part, the fields that are messages, with what their types lack.
    """

    package: str
    kind: str
    name: str
    names: Mapping[str, frozenset[str]]
    constants: frozenset[str] = frozenset()
    is_removed: bool = False
    field_types: Mapping[str, Mapping[str, LostInterface]] = field(default_factory=dict, compare=False)

    @property
    def type_name(self) -> str:
        """The name with the package, such as ``std_srvs/SetBool``."""
        return f"{self.package}/{self.name}"

    @property
    def inner_parts(self) -> Mapping[str, str]:
        """The parts by the names of their classes in ROS 2."""
        return {"srv": _SERVICE_PARTS, "action": _ACTION_PARTS}.get(self.kind, {})

    def find_classes(self, module: str) -> dict[str, str]:
        """Return the parts of the interface by the names of their classes in a module of Python, such as ``srv``."""
        if self.kind == "msg":
            return {self.name: ""} if module == "msg" else {}
        parts = {f"{self.name}{suffix}": part for suffix, part in self.inner_parts.items()}
        if self.kind == "srv":
            return {self.name: WHOLE, **parts} if module == "srv" else {}
        if module == "action":
            return {self.name: WHOLE}
        return {f"{self.name}Action": WHOLE, **parts} if module == "msg" else {}

    def lost_from(self, part: str) -> frozenset[str]:
        """Return the lost fields and constants of a part."""
        return self.names.get(part, frozenset())


@dataclass(frozen=True)
class InterfaceUse:
    """A place where a source uses what an interface lost.

    Attributes:
        interface: the interface.
        name: the lost field or constant with its part; empty for the interface itself.
        line: the line, starting at 1.
        column: the column, starting at 1.
    """

    interface: LostInterface
    name: str
    line: int
    column: int

    @property
    def key(self) -> tuple[str, str, str]:
        """A key that is equal for other uses of the same thing in a file."""
        return self.interface.type_name, self.interface.kind, self.name
