"""Messages of topics in the forms that a client may ask for: JSON, CBOR, and PNG."""

from __future__ import annotations

import json
import math
from base64 import b64encode
from typing import Any

from linkwright.bridge.rosbridge import bson, cbor
from linkwright.bridge.rosbridge.values import to_json_values

NONE, PNG, CBOR, CBOR_RAW = "none", "png", "cbor", "cbor-raw"
COMPRESSIONS = (NONE, PNG, CBOR, CBOR_RAW)
"""The forms of messages, in the order of precedence if a client asks for several."""


class MessageEncoder:
    """Encodes messages, and remembers the last one of each topic, because several clients may receive it.

    Args:
        bson_only: whether messages are BSON instead of JSON and PNG.
    """

    def __init__(self, *, bson_only: bool = False) -> None:
        self._bson_only = bson_only
        self._latest: dict[str, tuple[Any, dict[str, str | bytes]]] = {}

    def encode(self, topic: str, message: Any, compression: str) -> str | bytes:
        """Return a message as the text or the bytes that a client receives.

        Args:
            topic: the topic's name for the client.
            message: the message.
            compression: one of `COMPRESSIONS`, except for ``cbor-raw``.
        """
        latest_message, encoded = self._latest.get(topic, (None, {}))
        if latest_message is not message:
            encoded = {}
            self._latest[topic] = (message, encoded)
        if compression not in encoded:
            encoded[compression] = self._encode(topic, message, compression)
        return encoded[compression]

    def _encode(self, topic: str, message: Any, compression: str) -> str | bytes:
        content = {"op": "publish", "topic": topic, "msg": message}
        if compression == CBOR:
            return cbor.encode(content)
        if self._bson_only:
            return bson.encode(content)
        text = json.dumps(content, default=to_json_values)
        return json.dumps({"op": "png", "data": _write_png(text)}) if compression == PNG else text

    def drop(self, topic: str) -> None:
        """Forget the last message of a topic."""
        self._latest.pop(topic, None)


def encode_raw(topic: str, data: bytes, now: Any) -> bytes:
    """Return a serialized message, with the time of its reception, as ``cbor-raw``."""
    content = {"secs": now.sec, "nsecs": now.nanosec, "bytes": data}
    return cbor.encode({"op": "publish", "topic": topic, "msg": content})


def _write_png(text: str) -> str:
    """Return a text as the pixels of a PNG file, which are red, green and blue, in base64.

    The image is about square, and line feeds fill its last row.
    """
    import numpy as np

    from linkwright.images.png import png

    data = text.encode()
    width = max(1, math.isqrt(len(data) // 3))
    height = math.ceil(len(data) / (3 * width))
    pixels = np.frombuffer(data.ljust(3 * width * height, b"\n"), np.uint8).reshape(height, width, 3)
    return b64encode(png(pixels)).decode("ascii")
