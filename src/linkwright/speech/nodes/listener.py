"""A speech engine in a separate thread."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from queue import SimpleQueue
from typing import TypeAlias

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph import Node
from linkwright.speech.engine import Heard, SpeechEngine
from linkwright.speech.sound.samples import RATE, Samples

_MAX_PENDING_BLOCKS = 100
"""The maximum number of waiting blocks. An engine that is 10 s behind receives no new sound until it has caught up."""

_ThreadResult: TypeAlias = Heard | Diagnostic | LinkwrightError | None
"""A result of the thread. None means that all sound up to the end of an utterance was processed."""

_MAX_GAPS = 100
_GAP_TOLERANCE_S = 0.2  # in seconds; engines do not report the exact start of a word


class Listener:
    """A thread that passes sound to an engine, and the engine's results to the node.

    Args:
        node: the node that runs the functions below as callbacks.
        make_engine: creates the engine in the thread; this may take seconds.
        on_result: called with each result of the engine.
        on_finish: called when all sound before a call of `finish` was processed.
        on_problem: called with the reason why the engine recognizes less than it should, whenever the reason changes.
        on_error: called with the error that ended the engine.
    """

    def __init__(
        self,
        node: Node,
        make_engine: Callable[[], SpeechEngine],
        on_result: Callable[[Heard], None],
        on_finish: Callable[[], None],
        on_problem: Callable[[Diagnostic], None],
        on_error: Callable[[LinkwrightError], None],
    ) -> None:
        self._make_engine, self._on_result, self._on_finish, self._on_problem, self._on_error = (
            make_engine,
            on_result,
            on_finish,
            on_problem,
            on_error,
        )
        self._sample_count = 0
        self._gaps: deque[tuple[float, float]] = deque(maxlen=_MAX_GAPS)  # position and length of each gap
        self._blocks: SimpleQueue[Samples | bool | None] = SimpleQueue()
        self._results: deque[_ThreadResult] = deque()
        self._ready = node.create_guard_condition(self._run_callbacks)
        self._thread = threading.Thread(target=self._run, name="speech engine", daemon=True)
        self._thread.start()

    def add_sound(self, samples: Samples) -> bool:
        """Pass a block of sound to the engine, and return whether it was accepted.

        A block is dropped if the engine lags far behind.
        """
        if self._blocks.qsize() >= _MAX_PENDING_BLOCKS:
            self.record_gap(samples.size / RATE)
            return False
        self._sample_count += samples.size
        self._blocks.put(samples)
        return True

    def record_gap(self, seconds: float) -> None:
        """Record a gap in the sound before the next block.

        Args:
            seconds: the length of the gap.
        """
        self._gaps.append((self._sample_count / RATE, seconds))

    def missing_seconds(self, result: Heard) -> float:
        """Return the seconds of sound that are missing within a result, or just before or after it."""
        return sum(
            seconds
            for position, seconds in self._gaps
            if result.start - _GAP_TOLERANCE_S <= position <= result.end + _GAP_TOLERANCE_S
        )

    def finish(self) -> None:
        """End the current utterance."""
        self._blocks.put(True)

    def close(self) -> None:
        """Stop the thread, and close the engine."""
        self._blocks.put(None)
        self._thread.join()

    def _run(self) -> None:
        try:
            self._process_blocks()
        except LinkwrightError as error:
            self._queue_result(error)
        except Exception as error:  # noqa: BLE001 - another package's engine may raise anything
            message = phrase("the speech engine failed: {problem}", problem=foreign(f"{type(error).__name__}: {error}"))
            self._queue_result(LinkwrightError(Diagnostic("VOICE307", message)))

    def _process_blocks(self) -> None:
        engine = self._make_engine()
        problem = None
        try:
            while True:
                if engine.problem != problem:
                    problem = engine.problem
                    if problem is not None:
                        self._queue_result(problem)
                if (block := self._blocks.get()) is None:
                    return
                if isinstance(block, bool):
                    results: list[_ThreadResult] = [*engine.finish(), None]
                else:
                    results = [*engine.hear(block)]
                for result in results:
                    self._queue_result(result)
        finally:
            engine.close()

    def _queue_result(self, result: _ThreadResult) -> None:
        self._results.append(result)
        self._ready.trigger()

    def _run_callbacks(self) -> None:
        while self._results:
            result = self._results.popleft()
            if isinstance(result, LinkwrightError):
                self._on_error(result)
            elif isinstance(result, Diagnostic):
                self._on_problem(result)
            elif result is None:
                self._on_finish()
            else:
                self._on_result(result)
