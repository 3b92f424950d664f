"""A thread that runs a simulation in parallel with the event loop."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from math import inf

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import run_logged
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.worlds import find_physics
from linkwright.simulation.server.pace import PaceWatch
from linkwright.simulation.server.server import SimulationServer

_CHUNK_S = 0.005
"""The real time in s between two checks for commands."""
_MAX_CHUNK_S = 0.05
"""The maximum simulated time in s between two checks. All messages published in between arrive together."""
_MAX_DELAY_S = 0.25
"""The maximum delay, in s of real time, for which a simulation makes up by running faster."""
_PAUSED_PERIOD_S = 1 / 30
"""The maximum real time in s between two checks while the simulation is paused."""
_MEASUREMENT_PERIOD_S = 0.5
"""The real time in s over which the real-time factor is measured."""


class Runner:
    """A thread that advances a simulation at the requested real-time factor.

    All methods except `start` and `close` must be called in that thread, through commands of the exchange.

    Args:
        server: the server of the simulation.
        factor: the requested real-time factor; infinite for as fast as possible, 0 for the factor of the world.
        paused: whether the simulation starts paused.
        seconds: the simulated time in s after which the simulation ends; None for never.
        watch: called in the thread at short intervals, even while the simulation is paused.
        on_state: called in the thread after the simulation was paused or resumed.
        on_end: called in the thread with 0 after `seconds`; if `seconds` is set, also called with 1 after a failure.

    Attributes:
        is_paused: whether the simulation is paused.
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
        self.is_paused = paused
        self.real_time_factor = 0.0
        self._server = server
        self._pace = PaceWatch(server.show_pace)
        self._requested_factor = factor
        self._factor = 1.0
        self._remaining_ns = None if seconds is None else round(seconds * NANOSECONDS_PER_SECOND)
        self._watch, self._on_state, self._on_end = watch, on_state, on_end
        self._must_end = False
        server.on_change.append(self._restart_timing)
        self._reference_times = (0.0, 0)
        self._last_measurement = (0.0, 0)
        self._thread = threading.Thread(target=self._run, name="linkwright-simulation", daemon=True)

    def start(self) -> None:
        """Start the simulation's thread."""
        self._thread.start()

    def close(self) -> None:
        """Stop the thread after its current iteration, and wait until it has ended."""
        self._must_end = True
        self._server.exchange.close()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join()

    def pause(self) -> None:
        """Pause the simulation."""
        self._set_paused(paused=True)

    def resume(self) -> None:
        """Resume the simulation."""
        self._set_paused(paused=False)

    def step(self, count: int) -> None:
        """Run a number of steps as fast as possible.

        Raises:
            UnstableError: a value in the simulation is no longer finite.
        """
        self._server.simulation.advance(count * self._server.simulation.step)
        self._restart_timing()

    def _set_paused(self, *, paused: bool) -> None:
        if paused != self.is_paused:
            self.is_paused = paused
            self._restart_timing()
            self._on_state()

    def _restart_timing(self) -> None:
        """Restart the measurement of real time, and update the factor from the current world."""
        self._factor = (
            self._requested_factor or max(find_physics(self._server.simulation.world).real_time_factor, 0.0) or 1.0
        )
        self._reference_times = self._last_measurement = (time.monotonic(), self._server.simulation.time)

    def _run(self) -> None:
        exchange, dispatcher = self._server.exchange, self._server.node.graph.dispatcher
        self._restart_timing()
        while not self._must_end:
            self._call_logged(exchange.run_commands)
            wait_s = _PAUSED_PERIOD_S
            if not self.is_paused:
                self._call_logged(self._advance)
                wait_s = 0.0 if self.is_paused else self._compute_lead_s()
            self._measure()
            self._call_logged(self._watch)
            exchange.deliver(dispatcher)
            if wait_s > 0:
                exchange.has_commands.wait(wait_s)

    def _call_logged(self, function: Callable[[], object]) -> None:
        """Call a function, and log its error and pause the simulation if it raises one.

        A user can then reset the simulation.
        """
        run_logged(self._server.node.get_logger(), "the simulation", lambda: self._pause_on_error(function))

    def _pause_on_error(self, function: Callable[[], object]) -> None:
        try:
            function()
        except LinkwrightError as error:
            self._handle_failure()
            finding = error.diagnostics[0]
            hint = f" ({finding.hint})" if finding.hint else ""
            self._server.node.get_logger().error(f"{finding.message}{hint}")
        except BaseException:
            self._handle_failure()
            raise

    def _handle_failure(self) -> None:
        self.pause()
        if self._remaining_ns is not None:
            self._remaining_ns = None
            self._on_end(1)

    def _advance(self) -> None:
        simulation = self._server.simulation
        real_s = _CHUNK_S * (self._factor if self._factor < inf else 1.0)
        if self._factor == inf:
            real_s = _CHUNK_S * max(self.real_time_factor, 1.0)
        chunk_ns = max(round(min(real_s, _MAX_CHUNK_S) * NANOSECONDS_PER_SECOND), simulation.step)
        if self._remaining_ns is not None:
            chunk_ns = min(chunk_ns, self._remaining_ns)
        start_ns = simulation.time
        simulation.advance(chunk_ns)
        if self._remaining_ns is not None:
            self._remaining_ns -= simulation.time - start_ns
            if self._remaining_ns <= 0:
                self._remaining_ns = None
                self.pause()
                self._on_end(0)

    def _compute_lead_s(self) -> float:
        """Return the time in s until real time reaches simulated time.

        The time is 0 or less if the simulation is not ahead.

        A simulation that is too far behind does not have to catch up.
        """
        if self._factor == inf:
            return 0.0
        reference_real, reference_simulated = self._reference_times
        now = time.monotonic()
        lead_s = (
            reference_real
            + (self._server.simulation.time - reference_simulated) / NANOSECONDS_PER_SECOND / self._factor
            - now
        )
        if lead_s < -_MAX_DELAY_S:
            self._reference_times = now, self._server.simulation.time
        return lead_s

    def _measure(self) -> None:
        now, simulated = time.monotonic(), self._server.simulation.time
        elapsed = now - self._last_measurement[0]
        if elapsed >= _MEASUREMENT_PERIOD_S:
            self.real_time_factor = max(simulated - self._last_measurement[1], 0) / NANOSECONDS_PER_SECOND / elapsed
            self._last_measurement = now, simulated
            if not self.is_paused:
                self._pace.add(self.real_time_factor, self._factor, elapsed)
