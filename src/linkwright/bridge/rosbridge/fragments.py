"""Long messages in several parts, as the operation ``fragment`` of the protocol."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count
from typing import Any

from linkwright.bridge.rosbridge.requests import Request, RequestError

_MAX_MESSAGES = 32
"""The maximum number of incomplete messages of one client."""

_MAX_FRAGMENTS = 100_000
"""The maximum number of fragments of a message of a client."""

_MAX_SENT_FRAGMENTS = 1000
"""The maximum number of fragments of a message to a client."""

_numbers = count()


def split_message(text: str, size: int, identity: Any = None) -> tuple[str, ...]:
    """Return a message as it is, or as fragments if it is longer than a number of characters.

    Args:
        text: the message.
        size: the maximum number of characters; 0 for no limit. A size that gives too many fragments is increased.
        identity: the ID of the message; the fragments of a message without an ID have a number.
    """
    if size <= 0 or len(text) <= size:
        return (text,)
    size = max(size, len(text) // _MAX_SENT_FRAGMENTS + 1)
    total = (len(text) - 1) // size + 1
    fragment_id = next(_numbers) if identity is None else identity
    return tuple(
        json.dumps(
            {
                "op": "fragment",
                "id": fragment_id,
                "data": text[number * size : (number + 1) * size],
                "num": number,
                "total": total,
            }
        )
        for number in range(total)
    )


@dataclass(slots=True)
class _PartialMessage:
    total: int
    last_received_s: float = 0.0
    size: int = 0
    parts: dict[int, str] = field(default_factory=dict)


class Fragments:
    """The fragments that one client has sent.

    Args:
        timeout_s: the seconds after which an incomplete message is dropped.
        max_size: the maximum number of characters of a message.
        read_time: returns the time in seconds.
    """

    def __init__(self, timeout_s: float, max_size: int, read_time: Callable[[], float]) -> None:
        self._timeout_s = timeout_s
        self._max_size = max_size
        self._read_time = read_time
        self._messages: dict[str, _PartialMessage] = {}

    def add(self, request: Request) -> str | None:
        """Add a fragment, and return the whole message if it was the last one.

        Raises:
            RequestError: the fragment is not valid, or the message becomes too long.
        """
        self._drop_old_messages()
        total, number, data = request.read("total", int), request.read("num", int), request.read("data", str)
        if request.identity is None:
            raise RequestError("Expected an id field but none was found.")
        identity = str(request.identity)
        if not 0 <= number < total <= _MAX_FRAGMENTS:
            raise RequestError(f"fragment {number} of {total} is not valid")
        message = self._messages.get(identity)
        if message is None:
            if len(self._messages) >= _MAX_MESSAGES:
                raise RequestError(f"more than {_MAX_MESSAGES} messages are incomplete")
            message = self._messages[identity] = _PartialMessage(total)
        if total != message.total or number in message.parts:
            raise RequestError(f"fragment {number} of {total} does not fit the earlier fragments")
        message.last_received_s = self._read_time()
        message.size += len(data)
        message.parts[number] = data
        if message.size > self._max_size:
            del self._messages[identity]
            raise RequestError(f"the message is longer than {self._max_size} characters")
        if len(message.parts) < total:
            return None
        del self._messages[identity]
        return "".join(message.parts[index] for index in range(total))

    def _drop_old_messages(self) -> None:
        oldest_s = self._read_time() - self._timeout_s
        for identity, message in list(self._messages.items()):
            if message.last_received_s < oldest_s:
                del self._messages[identity]
