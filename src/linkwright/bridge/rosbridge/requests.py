"""Read the fields of clients' requests."""

from __future__ import annotations

from typing import Any, TypeVar, overload

_T = TypeVar("_T")


class RequestError(Exception):
    """Raised for a request that is not valid, or cannot be served. The message is for the client."""


class Request(dict[str, Any]):
    """A request of a client: the fields of its JSON object."""

    @property
    def identity(self) -> Any:
        """The ID of the request, or None."""
        return self.get("id")

    @overload
    def read(self, name: str, kind: type[_T]) -> _T: ...

    @overload
    def read(self, name: str, kind: type[_T], default: _T) -> _T: ...

    def read(self, name: str, kind: type[_T], default: _T | None = None) -> _T:
        """Return a field of a type.

        Raises:
            RequestError: it is missing and has no default, or has another type.
        """
        value = self.get(name, default)
        if value is None:
            if default is not None:
                return default
            raise RequestError(f"Expected a {name} field but none was found.")
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            raise RequestError(f"Expected field {name} to be {kind.__name__}. Invalid value: {str(value)[:60]}")
        return value

    def read_count(self, name: str) -> int:
        """Return a number that is not negative; 0 if there is none.

        Raises:
            RequestError: it is not a number, or is negative or too large.
        """
        value = self.get(name)
        if value is None:
            return 0
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value < 1e12:
            raise RequestError(f"Expected field {name} to be a number from 0. Invalid value: {str(value)[:60]}")
        return int(value)


def full_type_name(name: str, kind: str) -> str:
    """Return the full name of an interface type.

    The short form of ROS 1 and rosbridge, such as ``std_msgs/String``, is also accepted.

    Args:
        name: the name of the type.
        kind: ``msg``, ``srv`` or ``action``.
    """
    package, _, rest = name.strip("/").partition("/")
    return f"{package}/{kind}/{rest}" if rest and "/" not in rest else name


def split_numbered_name(name: str, identity: Any) -> tuple[str, Any]:
    """Split the old form ``NAME#ID`` of a service or action into the name and the ID."""
    name, _, old_identity = name.partition("#")
    return name, (old_identity or None) if identity is None else identity
