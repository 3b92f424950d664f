"""Support for the names that some keyword arguments had until ROS 2 Foxy.

An example is ``node_executable`` for ``executable``. Launch files from that time are still in use.
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import Any, TypeVar

_Class = TypeVar("_Class", bound=type)


def with_deprecated_arguments(**present: str) -> Callable[[_Class], _Class]:
    """Return a decorator for a class that also accepts former names of its keyword arguments.

    The use of a former name causes a warning with the current name.

    Args:
        **present: maps former names to current names.
    """

    def extend(kind: _Class) -> _Class:
        initialize = kind.__init__  # type: ignore[misc]  # the class itself is decorated

        @functools.wraps(initialize)
        def __init__(self: Any, *args: Any, **kwargs: Any) -> None:  # noqa: N807 - becomes the method of that name
            for former_name, current_name in present.items():
                if former_name not in kwargs:
                    continue
                if current_name in kwargs:
                    raise TypeError(
                        f"{kind.__name__} received '{former_name}' and '{current_name}': use '{current_name}' only"
                    )
                warnings.warn(
                    f"'{former_name}' of {kind.__name__} is deprecated: use '{current_name}'", UserWarning, stacklevel=2
                )
                kwargs[current_name] = kwargs.pop(former_name)
            initialize(self, *args, **kwargs)

        kind.__init__ = __init__  # type: ignore[misc]  # the decorator replaces it
        return kind

    return extend
