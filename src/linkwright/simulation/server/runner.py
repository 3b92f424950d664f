"""The thread that runs a simulation in parallel with the event loop."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from math import inf

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import run_logged
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.worlds import physics_of
from linkwright.simulation.server.server import SimulationServer

_CHUNK = 0.005
"""Real seconds between two looks at the commands."""
_LONGEST_CHUNK = 0.05
"""The most simulated seconds between them: messages published meanwhile arrive at once."""
_BEHIND = 0.25
"""Real seconds that a simulation may be behind; a greater delay is not caught up."""
_IDLE = 1 / 30
"""Real seconds between two looks while nothing moves."""
_MEASURED = 0.5
"""Real seconds over which the real-time factor is measured."""


class Runner:
    """Advances a simulation in a separate thread, at the requested real-time factor.

    All methods except `start` and `close` are called in that thread, through commands of the exchange.

    Args:
        server: the simulation.
        factor: simulated seconds per real second; infinite for as fast as possible, 0 for the factor of the world.
        paused: whether the simulation starts paused.
        seconds: the simulated seconds after which the simulation ends; None for never.
        watch: called in the thread at short intervals, even while the simulation is paused.
        on_state: called in the thread when the simulation was paused or resumed.
        on_end: called in the thread with 0 after `seconds`, or with 1 after a failure.

    Attributes:
        paused: whether the simulation is paused.
        real_time_factor: the recent number of simulated seconds per real second.
    """

    def __init__(
        self,
        server: SimulationServer,
        *,
        factor: float = 0.0,
        paused: bool = False,
        seconds: float | None = None,
        watch: Callable[[], None] = lambda: None,
        on_state: Callable[[], None] = lambda: None,
        on_end: Callable[[int], None] = lambda _: None,
    ) -> None:
        self.paused = paused
        self.real_time_factor = 0.0
        self._server = server
        self._given_factor = factor
        self._factor = 1.0
        self._left = None if seconds is None else round(seconds * NANOSECONDS_PER_SECOND)
        self._watch, self._on_state, self._on_end = watch, on_state, on_end
        self._ends = False
        server.on_change.append(self._wake)
        self._began = (0.0, 0)
        self._measured = (0.0, 0)
        self._thread = threading.Thread(target=self._run, name="linkwright-simulation", daemon=True)

    def start(self) -> None:
        """Start the simulation's thread."""
        self._thread.start()

    def close(self) -> None:
        """End the thread after the current step, and wait for its end."""
        self._ends = True
        self._server.exchange.close()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join()

    def pause(self) -> None:
        """Pause the simulation."""
        self._set(paused=True)

    def resume(self) -> None:
        """Resume the simulation."""
        self._set(paused=False)

    def step(self, count: int) -> None:
        """Run a number of steps as fast as possible.

        Raises:
            UnstableError: a value in the simulation is no longer finite.
        """
        self._server.simulation.advance(count * self._server.simulation.step)
        self._wake()

    def _set(self, *, paused: bool) -> None:
        if paused != self.paused:
            self.paused = paused
            self._wake()
            self._on_state()

    def _wake(self) -> None:
        """Restart the measurement of real time, with the real-time factor of the current world."""
        self._factor = self._given_factor or max(physics_of(self._server.simulation.world).real_time_factor, 0.0) or 1.0
        self._began = self._measured = (time.monotonic(), self._server.simulation.time)

    def _run(self) -> None:
        exchange, dispatcher = self._server.exchange, self._server.node.graph.dispatcher
        self._wake()
        while not self._ends:
            self._call_logged(exchange.run_commands)
            wait = _IDLE
            if not self.paused:
                self._call_logged(self._advance)
                wait = 0.0 if self.paused else self._ahead()
            self._measure()
            self._call_logged(self._watch)
            exchange.deliver(dispatcher)
            if wait > 0:
                exchange.has_commands.wait(wait)

    def _call_logged(self, work: Callable[[], object]) -> None:
        """Call a function; if it raises an error, log the error and pause the simulation.

        The simulation can then be reset.
        """
        run_logged(self._server.node.get_logger(), "the simulation", lambda: self._try(work))

    def _try(self, work: Callable[[], object]) -> None:
        try:
            work()
        except LinkwrightError as error:
            self._fail()
            finding = error.diagnostics[0]
            hint = f" ({finding.hint})" if finding.hint else ""
            self._server.node.get_logger().error(f"{finding.message}{hint}")
        except BaseException:
            self._fail()
            raise

    def _fail(self) -> None:
        self.pause()
        if self._left is not None:
            self._left = None
            self._on_end(1)

    def _advance(self) -> None:
        simulation = self._server.simulation
        real = _CHUNK * (self._factor if self._factor < inf else 1.0)
        if self._factor == inf:
            real = _CHUNK * max(self.real_time_factor, 1.0)
        chunk = max(round(min(real, _LONGEST_CHUNK) * NANOSECONDS_PER_SECOND), simulation.step)
        if self._left is not None:
            chunk = min(chunk, self._left)
        before = simulation.time
        simulation.advance(chunk)
        if self._left is not None:
            self._left -= simulation.time - before
            if self._left <= 0:
                self._left = None
                self.pause()
                self._on_end(0)

    def _ahead(self) -> float:
        """Return the real seconds until real time reaches simulated time; 0 or less if there is none.

        A simulation that is too far behind is not required to catch up.
        """
        if self._factor == inf:
            return 0.0
        real, simulated = self._began
        now = time.monotonic()
        ahead = real + (self._server.simulation.time - simulated) / NANOSECONDS_PER_SECOND / self._factor - now
        if ahead < -_BEHIND:
            self._began = now, self._server.simulation.time
        return ahead

    def _measure(self) -> None:
        now, simulated = time.monotonic(), self._server.simulation.time
        passed = now - self._measured[0]
        if passed >= _MEASURED:
            self.real_time_factor = max(simulated - self._measured[1], 0) / NANOSECONDS_PER_SECOND / passed
            self._measured = now, simulated
