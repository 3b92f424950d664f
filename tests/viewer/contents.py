"""The unpacked contents of a viewer for pages; for tests."""

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
    """Return the contents of a frame of `pack_data`."""
    kind, length, _, _ = struct.unpack_from("<IIII", frame)
    assert kind == 2
    header = json.loads(frame[16 : 16 + length])
    start = -(-(16 + length) // 8) * 8

    def plain(value: Any) -> Any:
        if isinstance(value, dict) and "$" in value:
            name, offset, count = value["$"]
            return np.frombuffer(frame, _TYPES[name], count, start + offset)
        if isinstance(value, dict):
            return {name: plain(field) for name, field in value.items()}
        return [plain(element) for element in value] if isinstance(value, list) else value

    fields = {name: plain(value) for name, value in header["content"].items()}
    return Content(header["key"], header["frame"], header["pose"], header["stamp"], fields)


def unpack_contents(display: Any) -> list[Content]:
    """Return the messages about a display for a page that opens now."""
    return [unpack(getattr(frame, "full_frame", frame)) for frame in display.data()]


def shown_markers(display: Any) -> dict[str, dict[str, Any]]:
    """Return the markers of a display by their IDs, as a page that opens now receives them."""
    store, *_ = display.data()
    frame, _ = store.since(0)
    return {} if frame is None else {marker["id"]: marker for marker in unpack(frame).fields["markers"]}
