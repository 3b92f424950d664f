"""The programs that run in a stepped graph."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from importlib.util import find_spec

from linkwright.graph import Graph, JumpClock
from linkwright.pytest_plugin import offer_stand_ins
from linkwright.testing.programs import patches
from linkwright.testing.programs.program import Main, Program
from linkwright.testing.programs.threads import BudgetExceededError, Turns

_INTERRUPT_TIMEOUT_S = 5.0
"""The simulated seconds in which a program must end after Ctrl-C, as under ``ros2 launch``."""

_END_STEP_S = 0.1


class Programs:
    """The programs in a stepped graph, which are run in its steps and ended with it.

    Args:
        graph: the stepped graph.
        clock: the clock of the graph.
        on_error: receives the exceptions that end programs.
    """

    def __init__(self, graph: Graph, clock: JumpClock, on_error: Callable[[BaseException], None]) -> None:
        self._graph = graph
        self._on_error = on_error
        self._turns = Turns(clock)
        self._programs: list[Program] = []
        self._reported: list[Program] = []
        self._budget_s = 0.0
        clock.attach(self)

    def start(self, main: Main, arguments: Sequence[str], budget_s: float, seed: int) -> Program:
        """Start a program, which first runs in the next step. See ``SteppedGraph.start_program``."""
        _offer_rclpy()
        if not self._programs:
            patches.install(self)
        self._budget_s = budget_s
        try:
            program = Program(main, arguments, self._graph, self._turns, seed)
        except BaseException:
            if not self._programs:
                patches.uninstall(self)
            raise
        self._programs.append(program)
        return program

    @property
    def node_names(self) -> list[tuple[str, str]]:
        """The name and the namespace of each current node of the programs."""
        return [names for program in self._programs for names in program.node_names]

    async def settle(self) -> None:
        """Run the programs and the callbacks of the graph until all of them wait."""
        self._turns.wake_pollers()
        while self._run_threads():
            await self._graph.settle()

    async def end(self, advance: Callable[[float], Awaitable[object]]) -> None:
        """Interrupt the programs, wait for their end, and kill programs that do not end.

        Args:
            advance: advances the time of the graph by a number of seconds.
        """
        if not self._programs:
            return
        try:
            for program in self._programs:
                if program.is_running:
                    program.interrupt()
            await self.settle()
            remaining_s = _INTERRUPT_TIMEOUT_S
            while remaining_s > 0 and any(program.is_running for program in self._programs):
                await advance(_END_STEP_S)
                remaining_s -= _END_STEP_S
            for program in self._programs:
                program.kill()
            await self.settle()
        finally:
            self._programs.clear()
            patches.uninstall(self)

    def _run_threads(self) -> bool:
        has_run = False
        try:
            has_run = self._turns.run(self._budget_s)
        except BudgetExceededError as error:
            has_run = True
            self._on_error(error)
        for program in self._programs:
            if program.error is not None and program not in self._reported:
                self._reported.append(program)
                self._on_error(program.error)
        return has_run


def _offer_rclpy() -> None:
    """Make ``rclpy`` importable.

    Raises:
        RuntimeError: another rclpy is installed, whose threads and time cannot be controlled.
    """
    offer_stand_ins()
    spec = find_spec("rclpy")
    if spec is not None and spec.has_location and spec.origin is not None and spec.origin.endswith(".py"):
        raise RuntimeError(
            f"programs in a stepped graph need the rclpy of Linkwright, but '{spec.origin}' is installed"
        )
