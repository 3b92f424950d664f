"""Run a speech engine in a separate thread."""

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

_MOST_WAITING = 100
"""Blocks: an engine that is 10 s behind gets no new sound until it has caught up."""

_Found: TypeAlias = Heard | Diagnostic | LinkwrightError | None
"""Results of the thread; None: all sound up to the end of the utterance was processed."""

_MOST_GAPS = 100
_NEAR = 0.2  # s: engines do not know the exact start of a word


class Listener:
    """Passes sound to an engine, and its results to the node.

    Args:
        node: the node, which runs `heard` and `failed` as callbacks.
        make: creates the engine in the thread, which may take seconds.
        heard: called with each result.
        finished: called when all speech before `finish` was processed.
        warn: called with the reason why an engine does not recognise anything, whenever it changes.
        failed: called with the error that ended the engine.
    """

    def __init__(
        self,
        node: Node,
        make: Callable[[], SpeechEngine],
        heard: Callable[[Heard], None],
        finished: Callable[[], None],
        warn: Callable[[Diagnostic], None],
        failed: Callable[[LinkwrightError], None],
    ) -> None:
        self._make, self._heard, self._finished, self._warn, self._failed = make, heard, finished, warn, failed
        self._handed = 0
        self._gaps: deque[tuple[float, float]] = deque(maxlen=_MOST_GAPS)  # position and length of each gap
        self._sound: SimpleQueue[Samples | bool | None] = SimpleQueue()
        self._found: deque[_Found] = deque()
        self._ready = node.create_guard_condition(self._deliver)
        self._thread = threading.Thread(target=self._run, name="speech engine", daemon=True)
        self._thread.start()

    def hear(self, samples: Samples) -> bool:
        """Pass a block of sound to the engine.

        Returns False if the engine lags behind and the block was dropped.
        """
        if self._sound.qsize() >= _MOST_WAITING:
            self.note_gap(samples.size / RATE)
            return False
        self._handed += samples.size
        self._sound.put(samples)
        return True

    def note_gap(self, seconds: float) -> None:
        """Record missing sound, in seconds, before the next block."""
        self._gaps.append((self._handed / RATE, seconds))

    def lost_in(self, heard: Heard) -> float:
        """Return the seconds of sound that were missing in a result, or just before or after it."""
        return sum(seconds for at, seconds in self._gaps if heard.start - _NEAR <= at <= heard.end + _NEAR)

    def finish(self) -> None:
        """End the utterance."""
        self._sound.put(True)

    def close(self) -> None:
        """Close the engine."""
        self._sound.put(None)
        self._thread.join()

    def _run(self) -> None:
        try:
            self._serve()
        except LinkwrightError as error:
            self._pass(error)
        except Exception as error:  # noqa: BLE001 - of an engine that others may bring
            message = phrase("the speech engine failed: {problem}", problem=foreign(f"{type(error).__name__}: {error}"))
            self._pass(LinkwrightError(Diagnostic("VOICE307", message)))

    def _serve(self) -> None:
        engine = self._make()
        problem = None
        try:
            while True:
                if engine.problem != problem:
                    problem = engine.problem
                    if problem is not None:
                        self._pass(problem)
                if (block := self._sound.get()) is None:
                    return
                if isinstance(block, bool):
                    found: list[_Found] = [*engine.finish(), None]
                else:
                    found = [*engine.hear(block)]
                for result in found:
                    self._pass(result)
        finally:
            engine.close()

    def _pass(self, found: _Found) -> None:
        self._found.append(found)
        self._ready.trigger()

    def _deliver(self) -> None:
        while self._found:
            found = self._found.popleft()
            if isinstance(found, LinkwrightError):
                self._failed(found)
            elif isinstance(found, Diagnostic):
                self._warn(found)
            elif found is None:
                self._finished()
            else:
                self._heard(found)
