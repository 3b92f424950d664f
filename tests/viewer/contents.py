"""What pages would be sent to draw, unpacked; for tests."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np

_TYPES = {"f4": "<f4", "u1": "u1"}


@dataclass
class Content:
    """One binary frame; arrays are flat."""

    key: str
    frame: str
    pose: list[float] | None
    stamp: float
    fields: dict[str, Any]


def unpack(frame: bytes) -> Content:
    """A frame of `pack_data`."""
    kind, length, _, _ = struct.unpack_from("<IIII", frame)
    assert kind == 2
    header = json.loads(frame[16 : 16 + length])
    start = -(-(16 + length) // 8) * 8

    def plain(value: Any) -> Any:
        if isinstance(value, dict) and "$" in value:
            name, offset, count = value["$"]
            return np.frombuffer(frame, _TYPES[name], count, start + offset)
        if isinstance(value, dict):
            return {name: plain(each) for name, each in value.items()}
        return [plain(each) for each in value] if isinstance(value, list) else value

    fields = {name: plain(value) for name, value in header["content"].items()}
    return Content(header["key"], header["frame"], header["pose"], header["stamp"], fields)


def contents(display: Any) -> list[Content]:
    """What a page that opens now would be sent of a display."""
    return [unpack(getattr(frame, "full_frame", frame)) for frame in display.data()]


def shown_markers(display: Any) -> dict[str, dict[str, Any]]:
    """The markers of a display that is drawn as markers, by their ids, as a page that opens now would be sent them."""
    (store,) = display.data()
    frame, _ = store.since(0)
    return {} if frame is None else {each["id"]: each for each in unpack(frame).fields["markers"]}
