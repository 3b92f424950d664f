"""Worker processes that make images in parallel."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from collections import deque
from collections.abc import Iterator
from contextlib import suppress
from multiprocessing.connection import Connection, wait

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.vision.datasets.making import CHAPTER, LabelledImage, Source, Studio

_PATIENCE = 10.0
"""Seconds that a process has to exit before it is killed."""


def make_in_processes(source: Source, numbers: range, workers: int) -> Iterator[LabelledImage]:
    """Yield images that several processes make.

    Args:
        source: the worlds and options.
        numbers: the numbers of the images.
        workers: the number of processes.

    Yields:
        The images, in the order of completion.

    Raises:
        LinkwrightError: VISION208, a process has died.
    """
    waiting = deque(_chapters(numbers))
    started: list[_Worker] = []
    try:
        started += [_Worker(source) for _ in range(min(workers, len(waiting)))]
        busy = {worker.connection: worker for worker in started}
        for worker in started:
            worker.assign(waiting.popleft())
        while busy:
            for ready in wait(list(busy)):
                worker = busy[ready]  # type: ignore[index]  # connections only were waited for
                taken = worker.result()
                if isinstance(taken, LabelledImage):
                    yield taken
                    worker.left -= 1
                if not worker.left:
                    if waiting:
                        worker.assign(waiting.popleft())
                    else:
                        del busy[worker.connection]
    finally:
        for worker in started:
            worker.stop()


def _chapters(numbers: range) -> Iterator[range]:
    """Yield ranges of image numbers that share their patterns."""
    start = numbers.start
    while start < numbers.stop:
        end = min((start // CHAPTER + 1) * CHAPTER, numbers.stop)
        yield range(start, end)
        start = end


class _Worker:
    def __init__(self, source: Source) -> None:
        spawn = multiprocessing.get_context("spawn")
        self.connection, theirs = spawn.Pipe()
        self.left = 0
        self._process = spawn.Process(target=_serve, args=(source, theirs), daemon=True)
        before = signal.signal(signal.SIGINT, signal.SIG_IGN)  # inherited: only the parent handles Ctrl-C
        try:
            self._process.start()
        finally:
            signal.signal(signal.SIGINT, before)
        theirs.close()

    def assign(self, numbers: range) -> None:
        """Send the process the numbers of the images to make next."""
        self.left = len(numbers)
        with suppress(OSError):  # the process has died, which `result` reports
            self.connection.send(numbers)

    def result(self) -> LabelledImage:
        """Return the next image.

        Raises:
            LinkwrightError: the error that the process reports, or VISION208 if it has died.
        """
        try:
            reply = self.connection.recv()
        except (EOFError, OSError):
            message = phrase("a process that renders images has died")
            hint = phrase("if memory is short, use fewer processes: --workers 1")
            raise LinkwrightError(Diagnostic("VISION208", message, hint=hint)) from None
        if isinstance(reply, LabelledImage):
            return reply
        raise LinkwrightError(*reply)

    def stop(self) -> None:
        """Kill the process."""
        self.connection.close()
        self._process.terminate()
        self._process.join(_PATIENCE)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()
        self._process.close()


def _serve(source: Source, connection: Connection) -> None:
    """Run a worker process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    sys.stdout = sys.stderr
    with suppress(EOFError, OSError):
        try:
            studio = Studio(source)
        except LinkwrightError as error:
            connection.send(error.diagnostics)
            return
        while True:
            for number in connection.recv():
                connection.send(studio.make(number))


def _end_with_parent() -> None:
    """End this process when its parent ends, for any reason."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
    os._exit(1)
