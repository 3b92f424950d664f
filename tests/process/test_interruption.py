"""Ctrl-C in situations in which Python ignores it."""

from __future__ import annotations

import subprocess
import sys
import textwrap

PROGRAM = """
    import os, signal, time
    from linkwright.process.interruption import end_on_interrupt, raise_interrupts

    class Dropping:
        def __del__(self):
            os.kill(os.getpid(), signal.SIGINT)
            for _ in range(1000):
                pass

    end_on_interrupt()
    raise_interrupts()
    try:
        Dropping()
        time.sleep(20)
    except KeyboardInterrupt:
        print("caught")
"""


def test_ctrl_c_in_destructor_is_raised_again() -> None:
    result = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(PROGRAM)], capture_output=True, text=True, timeout=60, check=False
    )
    assert (result.stdout, result.stderr) == ("caught\n", "")
