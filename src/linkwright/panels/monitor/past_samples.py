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


_MOST_READ = 3000
"""Most messages to read; of more, evenly spread ones: reading one takes some ten microseconds."""


def sample_of(path: FieldPath, message: Any, received_ns: int) -> tuple[float, float, float] | None:
    """Return a sample of a field: receive time, header stamp (NaN if there is none), and value.

    The times are in seconds. Returns None if the message has no such field.
    """
    value = path.value(message)
    if value is None:
        return None
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    stamped = math.nan if stamp is None else stamp.nanoseconds / NANOSECONDS_PER_SECOND
    return received_ns / NANOSECONDS_PER_SECOND, stamped, value


def past_samples(path: FieldPath, cls: Any, messages: Sequence[Recorded]) -> NDArray[np.float64]:
    """Return the samples of recorded messages of a class, as rows of shape (3, M); see `sample_of`."""
    step = -(-len(messages) // _MOST_READ) or 1
    read = [sample_of(path, deserialize(data, cls), stamp_ns) for _, stamp_ns, data in messages[::-1][::step]]
    return np.array([sample for sample in reversed(read) if sample is not None], dtype=np.float64).reshape(-1, 3).T
