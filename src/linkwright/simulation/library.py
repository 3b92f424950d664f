"""Access to the MuJoCo library, a dependency of the extra ``sim``.

The extra installs version 4, or on Python 3.10 the newest version that has wheels for it.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from linkwright.diagnostics import missing_extra


@cache
def load_mujoco() -> Any:
    """Return the module ``mujoco``, with its printed warnings disabled.

    The module has no type annotations.

    Raises:
        LinkwrightError: SIM101, MuJoCo is not installed.
    """
    try:
        import mujoco  # type: ignore[import-untyped, unused-ignore]
    except ModuleNotFoundError as error:
        raise missing_extra("SIM101", error) from None
    mujoco.set_mju_user_warning(_discard_warning)
    return mujoco


def _discard_warning(text: str) -> None:
    """Discard a MuJoCo warning.

    Callers read the warnings from MuJoCo's data instead, and report them.
    """
