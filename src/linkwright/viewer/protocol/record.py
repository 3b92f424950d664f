"""How messages of the protocol and their parts are declared."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

__all__ = ["record"]

if TYPE_CHECKING:
    from dataclasses import dataclass as record
else:

    def record(cls: type[Any]) -> type[Any]:
        """A dataclass with slots. How it is printed and compared is not compiled anew for each, which halves the time.

        There are more than 150 of them, and no page is answered before the last is made.
        """
        made = dataclasses.dataclass(slots=True, repr=False, eq=False, match_args=False)(cls)
        made.__repr__, made.__eq__, made.__hash__ = _shown, _is_same, None
        return made


def _shown(self: Any) -> str:
    values = (f"{field.name}={getattr(self, field.name)!r}" for field in dataclasses.fields(self))
    return f"{type(self).__name__}({', '.join(values)})"


def _is_same(self: Any, other: Any) -> Any:
    if type(other) is not type(self):
        return NotImplemented
    return all(getattr(self, field.name) == getattr(other, field.name) for field in dataclasses.fields(self))
