"""Rates: sleeping at a fixed frequency (rclpy ``Rate``)."""

from __future__ import annotations

from linkwright.graph.faults import InterruptedWaitError
from linkwright.graph.loop.future import Future
from linkwright.graph.loop.timer import Timer


class Rate:
    """Lets a loop turn at a fixed rate: each `sleep` ends with the next beat of a timer.

    The timer's callbacks must be run by another thread than the one that sleeps; a coroutine waits with `wait`. What
    comes late does not shift the beat.

    Args:
        timer: the timer that beats; the rate takes its callback.
    """

    def __init__(self, timer: Timer) -> None:
        self.timer = timer
        self._next: Future[None] = Future()
        self._ended = False
        timer.callback = self._beat
        timer.node.add_cleanup(self.wake)

    def sleep(self) -> None:
        """Block the calling thread until the next beat.

        Raises:
            InterruptedWaitError: the rate's node was destroyed, or its graph closed.
        """
        beat = self._begin()
        beat.wait()
        self._end()

    async def wait(self) -> None:
        """Wait for the next beat in a coroutine.

        Raises:
            InterruptedWaitError: the rate's node was destroyed, or its graph closed.
        """
        await self._begin()
        self._end()

    def wake(self) -> None:
        """End all sleep, now and later."""
        self._ended = True
        self._beat()

    def destroy(self) -> bool:
        """End the rate; who sleeps by it is woken. Returns whether it had not been destroyed before."""
        self.wake()
        self.timer.node.remove_cleanup(self.wake)
        return self.timer.node.remove(self.timer)

    def _begin(self) -> Future[None]:
        if self._ended or self.timer.destroyed:
            raise InterruptedWaitError
        if self.timer.is_canceled():
            self.timer.reset()
        return self._next

    def _end(self) -> None:
        if self._ended:
            raise InterruptedWaitError

    def _beat(self) -> None:
        ended, self._next = self._next, Future()
        ended.set_result(None)
