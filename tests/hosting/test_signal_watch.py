"""Signals before the start of a launch."""

from __future__ import annotations

import os
import signal
import sys
import time

import pytest

from linkwright.hosting import signals
from linkwright.hosting.signals import SignalWatch
from tests.waiting import TIMEOUT_S


class SignalsAtDeletion:
    """An object whose destructor sends a signal to this process."""

    def __init__(self, number: int) -> None:
        self._number = number

    def __del__(self) -> None:
        os.kill(os.getpid(), self._number)
        for _ in range(1000):  # Python handles the signal here
            pass


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_during_destructor_is_not_lost(
    number: int, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    # After the deadline, the watch would end the process of pytest.
    monkeypatch.setattr(signals, "_DEADLINE_S", TIMEOUT_S)
    hook = sys.unraisablehook
    watch = SignalWatch()

    def wait() -> None:
        with watch:
            SignalsAtDeletion(number)
            time.sleep(20)

    with pytest.raises(KeyboardInterrupt):
        wait()
    assert watch.exit_status == 128 + number
    assert sys.unraisablehook is hook
    assert capfd.readouterr().err == ""
