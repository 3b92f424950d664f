"""Commands that report when Linkwright handles Ctrl-C.

While Python starts, it sometimes drops a Ctrl-C without a trace ("Exception ignored in"). A test that interrupts a
command at any moment counts only from the moment at which Linkwright handles it.
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


def command_that_reports(module: str, *words: str) -> list[str]:
    """Return the command line of ``python -m MODULE WORDS`` that prints `BEGUN` first."""
    return [sys.executable, "-c", _PROGRAM, module, *words]
