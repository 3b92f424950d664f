"""Access to OMPL, a dependency of the extra ``arm``."""

from __future__ import annotations

import atexit
import gc
from functools import cache
from typing import Any

from linkwright.diagnostics import missing_extra


@cache
def load_ompl() -> Any:
    """Return the module ``ompl``, which then prints errors only.

    The module has no type annotations.

    Raises:
        LinkwrightError: ARM103, OMPL is not installed.
    """
    try:
        import ompl
        from ompl import base, geometric, util  # noqa: F401 - loaded as attributes of `ompl`
    except ModuleNotFoundError as error:
        raise missing_extra("ARM103", error) from None
    util.setLogLevel(util.LOG_NONE)
    # The command line freezes all objects at its end, and OMPL's bindings would report them as leaks.
    atexit.register(gc.unfreeze)
    return ompl
