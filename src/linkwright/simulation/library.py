"""The library MuJoCo, which the extra ``sim`` brings: version 4, and on Python 3.10 the last that has wheels for it."""

from __future__ import annotations

from functools import cache
from typing import Any

from linkwright.diagnostics import missing_extra


@cache
def load_mujoco() -> Any:
    """Import the module ``mujoco``, which has no types.

    Raises:
        LinkwrightError: SIM101 it is not installed.
    """
    try:
        import mujoco  # type: ignore[import-untyped, unused-ignore]
    except ModuleNotFoundError as error:
        raise missing_extra("SIM101", error) from None
    mujoco.set_mju_user_warning(_unheard)
    return mujoco


def _unheard(text: str) -> None:
    """A handler that drops MuJoCo's warnings: callers find them in its data, and report them."""
