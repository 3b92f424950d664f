"""Zstandard compression of large messages in memory, in a thread, where it makes them clearly smaller.

Images and clouds of a simulation shrink to a tenth or a hundredth; those with the noise of a real sensor hardly shrink.
The quickest level finds out at once which kind a message is.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from functools import cache
from queue import SimpleQueue
from typing import Any, Generic, TypeVar

_LEAST_BYTES = 16_384
"""Smaller messages stay as they are."""

_WORTH = 0.8
"""The part of its size below which a message is kept compressed: decompression takes time, too."""

_MOST_WAITING = 64_000_000
"""Bytes that wait for the thread; where more come than it can pack, the rest stays as it is."""

_LEVEL = 1

K = TypeVar("K")


class Packed(bytes):
    """A compressed message; its length is that of the compressed bytes."""

    __slots__ = ()


@cache
def _zstd() -> Any:
    """The library; None if the extra `bag` is not installed."""
    if sys.version_info >= (3, 14):
        from compression import zstd
    else:
        try:
            from backports import zstd
        except ModuleNotFoundError:
            return None
    return zstd


def whole(data: bytes) -> bytes:
    """The original bytes of a message."""
    return bytes(_zstd().decompress(data)) if type(data) is Packed else data


class Shrinker(Generic[K]):
    """Compresses messages in a thread of its own, which the first large one starts.

    Args:
        done: called in that thread with the key of a message and it packed.
    """

    def __init__(self, done: Callable[[K, Packed], object]) -> None:
        self._done = done
        self._queue: SimpleQueue[tuple[K, bytes] | None] = SimpleQueue()
        self._thread: threading.Thread | None = None
        self._waiting = 0
        self._lock = threading.Lock()

    def offer(self, key: K, data: bytes) -> None:
        """Compress a message when there is time, if it is large."""
        if len(data) < _LEAST_BYTES or _zstd() is None:
            return
        with self._lock:
            if self._waiting + len(data) > _MOST_WAITING:
                return
            self._waiting += len(data)
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="history", daemon=True)
                self._thread.start()
        self._queue.put((key, data))

    def close(self) -> None:
        """Stop compressing."""
        self._queue.put(None)

    def _run(self) -> None:
        while (offered := self._queue.get()) is not None:
            key, data = offered
            packed = _zstd().compress(data, _LEVEL)
            if len(packed) < _WORTH * len(data):
                self._done(key, Packed(packed))
            with self._lock:
                self._waiting -= len(data)
