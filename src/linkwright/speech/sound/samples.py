"""The format of sound in speech recognition."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

RATE = 16_000
"""Samples per second. Speech engines are trained at this rate, and the sound of microphones is resampled to it."""

BLOCK_LENGTH = RATE // 10
"""The number of samples in a block of a microphone: 100 ms."""

Samples: TypeAlias = NDArray[np.int16]
"""Mono 16-bit PCM, shape ``(n,)``, at `RATE`."""
