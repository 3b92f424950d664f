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
from linkwright.vision.datasets.rendering import IMAGES_PER_PATTERN_SET, DatasetInput, DatasetRenderer, LabeledImage

_EXIT_TIMEOUT_S = 10.0
"""The seconds that a process has to exit before it is killed."""


def make_in_processes(source: DatasetInput, numbers: range, workers: int) -> Iterator[LabeledImage]:
    """Yield images that several processes make at the same time.

    Args:
        source: the worlds and options.
        numbers: the numbers of the images.
        workers: the number of processes.

    Yields:
        Each image when it is finished, in no fixed order.

    Raises:
        LinkwrightError: VISION208, a process has died.
    """
    pending_ranges = deque(_split_by_patterns(numbers))
    workers_started: list[_Worker] = []
    try:
        workers_started += [_Worker(source) for _ in range(min(workers, len(pending_ranges)))]
        busy_workers = {worker.connection: worker for worker in workers_started}
        for worker in workers_started:
            worker.assign(pending_ranges.popleft())
        while busy_workers:
            for connection in wait(list(busy_workers)):
                worker = busy_workers[connection]  # type: ignore[index]  # connections only were waited for
                sample = worker.receive_image()
                if isinstance(sample, LabeledImage):
                    yield sample
                    worker.remaining_count -= 1
                if not worker.remaining_count:
                    if pending_ranges:
                        worker.assign(pending_ranges.popleft())
                    else:
                        del busy_workers[worker.connection]
    finally:
        for worker in workers_started:
            worker.stop()


def _split_by_patterns(numbers: range) -> Iterator[range]:
    """Yield the parts of a range of image numbers that each share one set of patterns."""
    start = numbers.start
    while start < numbers.stop:
        end = min((start // IMAGES_PER_PATTERN_SET + 1) * IMAGES_PER_PATTERN_SET, numbers.stop)
        yield range(start, end)
        start = end


class _Worker:
    def __init__(self, source: DatasetInput) -> None:
        spawn = multiprocessing.get_context("spawn")
        self.connection, child_connection = spawn.Pipe()
        self.remaining_count = 0
        self._process = spawn.Process(target=_run_worker, args=(source, child_connection), daemon=True)
        previous_handler = signal.signal(signal.SIGINT, signal.SIG_IGN)  # inherited: only the parent handles Ctrl-C
        try:
            self._process.start()
        finally:
            signal.signal(signal.SIGINT, previous_handler)
        child_connection.close()

    def assign(self, numbers: range) -> None:
        """Send the process the numbers of the images to make next."""
        self.remaining_count = len(numbers)
        with suppress(OSError):  # the process has died, which `receive_image` reports
            self.connection.send(numbers)

    def receive_image(self) -> LabeledImage:
        """Return the next image that the process finishes.

        Raises:
            LinkwrightError: the error that the process reports, or VISION208 if it has died.
        """
        try:
            reply = self.connection.recv()
        except (EOFError, OSError):
            message = phrase("a process that renders images has died")
            hint = phrase("if memory is short, use fewer processes, for example --workers 1")
            raise LinkwrightError(Diagnostic("VISION208", message, hint=hint)) from None
        if isinstance(reply, LabeledImage):
            return reply
        raise LinkwrightError(*reply)

    def stop(self) -> None:
        """Terminate the process, and kill it if it does not exit in time."""
        self.connection.close()
        self._process.terminate()
        self._process.join(_EXIT_TIMEOUT_S)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()
        self._process.close()


def _run_worker(source: DatasetInput, connection: Connection) -> None:
    """Make the requested images in a worker process until the connection is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_exit_with_parent, daemon=True).start()
    sys.stdout = sys.stderr
    with suppress(EOFError, OSError):
        try:
            renderer = DatasetRenderer(source)
        except LinkwrightError as error:
            connection.send(error.diagnostics)
            return
        while True:
            for number in connection.recv():
                connection.send(renderer.render_image(number))


def _exit_with_parent() -> None:
    """Exit this process as soon as its parent has ended, for any reason."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
    os._exit(1)
