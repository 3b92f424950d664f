"""Extracts plot samples from recorded messages."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import deserialize
from linkwright.panels.monitor.field_paths import FieldPath
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from linkwright.bag.names import Recorded


_MAX_MESSAGES = 3000
"""The largest number of messages to read, evenly spread, because reading one takes some ten microseconds."""


def read_sample(path: FieldPath, message: Any, received_ns: int) -> tuple[float, float, float] | None:
    """Return a sample of a field: receive time, stamp in the header (or NaN), and value.

    The times are in seconds since the epoch. The result is None if the message has no such field.
    """
    value = path.value(message)
    if value is None:
        return None
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    stamp_seconds = math.nan if stamp is None else stamp.nanoseconds / NANOSECONDS_PER_SECOND
    return received_ns / NANOSECONDS_PER_SECOND, stamp_seconds, value


def read_past_samples(path: FieldPath, cls: Any, messages: Sequence[Recorded]) -> NDArray[np.float64]:
    """Return the samples of recorded messages of a class, shape (3, M). See `read_sample`."""
    step = -(-len(messages) // _MAX_MESSAGES) or 1
    samples = [read_sample(path, deserialize(data, cls), stamp_ns) for _, stamp_ns, data in messages[::-1][::step]]
    return np.array([sample for sample in reversed(samples) if sample is not None], dtype=np.float64).reshape(-1, 3).T
