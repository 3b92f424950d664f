"""Signal handlers that run in the event loop."""

from __future__ import annotations

import asyncio
import signal
import sys

import pytest
from launch.utilities import AsyncSafeSignalManager

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no user signals")


@pytest.fixture
def previous_handler_calls():
    """Record the signals that are handled outside of the manager."""
    signals = []

    def note(number, _):
        signals.append(number)

    saved = {number: signal.signal(number, note) for number in (signal.SIGUSR1, signal.SIGUSR2)}
    yield signals
    for number, handler in saved.items():
        assert signal.getsignal(number) is note
        signal.signal(number, handler)


async def test_signal_handlers_run_in_loop_only_while_entered(previous_handler_calls):
    manager, received = AsyncSafeSignalManager(asyncio.get_running_loop()), []
    assert manager.handle(signal.SIGUSR1, received.append) is None
    signal.raise_signal(signal.SIGUSR1)
    assert previous_handler_calls == [signal.SIGUSR1]
    with manager:
        manager.handle(signal.SIGUSR2, received.append)
        signal.raise_signal(signal.SIGUSR1)
        assert received == []
        await asyncio.sleep(0)
        signal.raise_signal(signal.SIGUSR2)
        await asyncio.sleep(0)
        assert received == [signal.SIGUSR1, signal.SIGUSR2]
        assert manager.handle(signal.SIGUSR1, None) == received.append
        signal.raise_signal(signal.SIGUSR1)
        assert previous_handler_calls == [signal.SIGUSR1] * 2
    signal.raise_signal(signal.SIGUSR2)
    assert previous_handler_calls[-1] == signal.SIGUSR2
    with manager:
        signal.raise_signal(signal.SIGUSR2)
        await asyncio.sleep(0)
    assert received == [signal.SIGUSR1, signal.SIGUSR2, signal.SIGUSR2]


async def test_invalid_signal_number_is_rejected():
    with pytest.raises(ValueError, match="12345"):
        AsyncSafeSignalManager(asyncio.get_running_loop()).handle(12345, print)
