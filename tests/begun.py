"""Commands that say when Ctrl-C is ours to take care of.

While Python only starts itself it drops one now and then ("Exception ignored in"), and nobody learns of it. A test that
interrupts a command at any moment counts from the first moment that is ours.
"""

from __future__ import annotations

import sys

BEGUN = "begun"
"""The first line that such a command prints."""

_PROGRAM = f"""
import runpy, sys
from linkwright.process.interruption import end_on_interrupt
end_on_interrupt()
print({BEGUN!r}, flush=True)
sys.argv[:] = sys.argv[1:]
runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
"""


def telling(module: str, *words: str) -> list[str]:
    """The command line of ``python -m MODULE WORDS``, which prints `BEGUN` first."""
    return [sys.executable, "-c", _PROGRAM, module, *words]
