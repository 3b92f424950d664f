"""Tells numpy's values from others without importing numpy.

To import numpy takes longer than to import everything else that a verb such as ``topic list`` needs, and only fixed
arrays of numbers and transforms are kept in its arrays. Who never imported it has none of its values.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, TypeGuard

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def is_array(value: Any) -> TypeGuard[NDArray[Any]]:
    """Whether a value is a ``numpy.ndarray``."""
    array_class = ndarray_class()
    return array_class is not None and isinstance(value, array_class)


def is_scalar(value: Any) -> TypeGuard[np.generic]:
    """Whether a value is one of numpy's own numbers, such as ``numpy.float64``."""
    scalar_class = getattr(sys.modules.get("numpy"), "generic", None)
    return scalar_class is not None and isinstance(value, scalar_class)


def ndarray_class() -> type[NDArray[Any]] | None:
    """``numpy.ndarray``; None as long as nobody has imported numpy."""
    return getattr(sys.modules.get("numpy"), "ndarray", None)
