"""Support for the names that keyword arguments had up to ROS 2 Foxy.

An example is ``node_executable`` for ``executable``. Launch files from that time are still in use, and their other
contents are still valid.
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import Any, TypeVar

_Class = TypeVar("_Class", bound=type)


def with_deprecated_arguments(**present: str) -> Callable[[_Class], _Class]:
    """Make a class accept former names of keyword arguments.

    Their use causes a warning that gives the current names.

    Args:
        present: former name -> current name.
    """

    def extend(kind: _Class) -> _Class:
        initialize = kind.__init__  # type: ignore[misc]  # of the class itself, not of an instance

        @functools.wraps(initialize)
        def __init__(self: Any, *args: Any, **kwargs: Any) -> None:  # noqa: N807 - becomes the method of that name
            for former, name in present.items():
                if former not in kwargs:
                    continue
                if name in kwargs:
                    raise TypeError(f"{kind.__name__} is given both '{former}' and '{name}', which is its name now")
                warnings.warn(f"'{former}' of {kind.__name__} is called '{name}' now", UserWarning, stacklevel=2)
                kwargs[name] = kwargs.pop(former)
            initialize(self, *args, **kwargs)

        kind.__init__ = __init__  # type: ignore[misc]  # on purpose
        return kind

    return extend
