"""The format of sound in this room."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

RATE = 16_000
"""Samples a second. Engines of speech are trained at this rate; microphones are resampled to it where they are read."""

BLOCK = RATE // 10
"""Samples of the blocks in which microphones deliver: 100 ms."""

Samples: TypeAlias = NDArray[np.int16]
"""Mono PCM of 16 bits, little-endian, shape ``(n,)``, at `RATE`."""
