"""The protocol of pygls for a server that runs for days."""

from __future__ import annotations

from typing import Any

from pygls.protocol import LanguageServerProtocol


class LeanProtocol(LanguageServerProtocol):
    """A protocol that drops the future of a message when it has been handled.

    Pygls 2.1 stores the future of each notification, so the memory grows with each edit.
    """

    def _execute_handler(
        self,
        msg_id: str | int,
        handler: Any,
        callback: Any,
        args: tuple[Any, ...] | None = None,
        kwargs: dict[str, Any] | None = None,
    ) -> None:
        super()._execute_handler(msg_id, handler, callback, args, kwargs)
        future = self._request_futures.get(msg_id)
        if future is not None:
            future.add_done_callback(lambda _: self._request_futures.pop(msg_id, None))
