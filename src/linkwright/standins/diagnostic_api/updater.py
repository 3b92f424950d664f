"""Tasks and the updater that runs and publishes them (API of ``diagnostic_updater``)."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from linkwright.standins.diagnostic_api.status import DiagnosticArray, DiagnosticStatus, DiagnosticStatusWrapper

_NO_HARDWARE_ID = (
    "diagnostic_updater: No HW_ID was set. This is probably a bug. Please report it. For devices that do not have a "
    "HW_ID, set this value to none. This warning only occurs once all diagnostics are OK so it is okay to wait until "
    "the device is open before calling setHardwareID."
)


class DiagnosticTask:
    """The base class of tasks: a name, and a method that fills a status.

    Args:
        name: the name of the task.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def getName(self) -> str:
        """Return the name of the task."""
        return self.name

    def run(self, stat: Any) -> Any:
        """Fill a `DiagnosticStatusWrapper` and return it."""
        return stat


class FunctionDiagnosticTask(DiagnosticTask):
    """A task that calls a function.

    Args:
        name: the name of the task.
        fn: fills a `DiagnosticStatusWrapper` and returns it.
    """

    def __init__(self, name: str, fn: Callable[[Any], Any]) -> None:
        super().__init__(name)
        self.fn = fn

    def run(self, stat: Any) -> Any:
        """Return the result of the function."""
        return self.fn(stat)


class CompositeDiagnosticTask(DiagnosticTask):
    """Several tasks with one status: the values of all, and their merged summary.

    Args:
        name: the name of the task.
    """

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.tasks: list[DiagnosticTask] = []

    def run(self, stat: Any) -> Any:
        """Run the tasks one after another, each with the summary that was passed, and merge their summaries."""
        merged, initial = DiagnosticStatusWrapper(), DiagnosticStatusWrapper()
        initial.summary(stat)
        for task in self.tasks:
            stat.summary(initial)
            stat = task.run(stat)
            merged.mergeSummary(stat)
        stat.summary(merged)
        return stat

    def addTask(self, t: DiagnosticTask) -> None:
        """Add a task."""
        self.tasks.append(t)


class DiagnosticTaskVector:
    """A list of tasks, which several threads may change."""

    class DiagnosticTaskInternal:
        """A task of the list: its name and its function."""

        def __init__(self, name: str, fn: Callable[[Any], Any]) -> None:
            self.name = name
            self.fn = fn

        def run(self, stat: Any) -> Any:
            """Fill a status that has the name of the task."""
            stat.name = self.name
            return self.fn(stat)

    def __init__(self) -> None:
        self.tasks: list[DiagnosticTaskVector.DiagnosticTaskInternal] = []
        self.lock = threading.Lock()

    def addedTaskCallback(self, task: DiagnosticTaskInternal) -> None:
        """Do nothing. Subclasses publish that a task was added."""

    def add(self, *args: Any) -> None:
        """Add a task.

        Args:
            args: a `DiagnosticTask`, or a name and a function that fills a status and returns it.

        Raises:
            TypeError: there is another number of arguments.
        """
        if len(args) == 1:
            args = args[0].getName(), args[0].run
        if len(args) != 2:
            raise TypeError(
                f"a task is a DiagnosticTask, or a name and a function, but there are {len(args)} arguments"
            )
        task = self.DiagnosticTaskInternal(*args)
        with self.lock:
            self.tasks.append(task)
            self.addedTaskCallback(task)

    def removeByName(self, name: str) -> bool:
        """Remove the first task with a name, and return whether there was one."""
        with self.lock:
            for index, task in enumerate(self.tasks):
                if task.name == name:
                    del self.tasks[index]
                    return True
        return False


class Updater(DiagnosticTaskVector):
    """Runs tasks periodically, and publishes their statuses on ``/diagnostics``.

    The parameter ``diagnostic_updater.period`` of the node is the period in seconds. The parameter
    ``diagnostic_updater.use_fqn`` puts the node's namespace before its name.

    Attributes:
        verbose: whether each status that is not OK is logged.
        hwid: the ID of the hardware.

    Args:
        node: the node.
        period: the period in seconds if the parameter is not set.
    """

    def __init__(self, node: Any, period: float = 1.0) -> None:
        super().__init__()
        self.node = node
        self.publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 1)
        self.period_parameter = "diagnostic_updater.period"
        self._period = _declare_parameter(node, self.period_parameter, period)
        self.timer = node.create_timer(self._period, self.update)
        self.verbose = False
        self.hwid = ""
        self.warn_nohwid_done = False
        self.use_fqn_parameter = "diagnostic_updater.use_fqn"
        has_full_name = _declare_parameter(node, self.use_fqn_parameter, False)
        self.node_name = node.get_fully_qualified_name() if has_full_name else node.get_name()

    @property
    def period(self) -> float:
        """The period in seconds."""
        return float(self._period)

    @period.setter
    def period(self, period: float) -> None:
        self._period = period
        self.node.destroy_timer(self.timer)
        self.timer = self.node.create_timer(period, self.update)

    def update(self) -> None:
        """Run all tasks and publish their statuses.

        Raises:
            TypeError: a task does not return a status.
        """
        with self.lock:
            statuses = [self._run_task(task) for task in self.tasks]
        has_only_ok = all(status.level == DiagnosticStatus.OK for status in statuses)
        if not self.hwid and has_only_ok and not self.warn_nohwid_done:
            self.node.get_logger().warning(_NO_HARDWARE_ID)
            self.warn_nohwid_done = True
        self.publish(statuses)

    def force_update(self) -> None:
        """Run all tasks and publish their statuses now."""
        self.update()

    def broadcast(self, lvl: bytes, msg: str) -> None:
        """Publish one level and message for all tasks."""
        self.publish([self._make_status(task, lvl, msg) for task in self.tasks])

    def setHardwareID(self, hwid: str) -> None:
        """Set the ID of the hardware in all statuses."""
        self.hwid = hwid

    def publish(self, msg: Any) -> None:
        """Publish a status or a list of statuses, with the node's name before their names."""
        array = DiagnosticArray()
        array.header.stamp = self.node.get_clock().now().to_msg()
        for stat in msg if isinstance(msg, list) else [msg]:
            array.status.append(
                DiagnosticStatus(
                    level=stat.level,
                    name=f"{self.node_name}: {stat.name}",
                    message=stat.message,
                    hardware_id=stat.hardware_id,
                    values=list(stat.values),
                )
            )
        self.publisher.publish(array)

    def addedTaskCallback(self, task: DiagnosticTaskVector.DiagnosticTaskInternal) -> None:
        """Publish that the node starts up."""
        self.publish(self._make_status(task, DiagnosticStatus.OK, "Node starting up"))

    def _run_task(self, task: DiagnosticTaskVector.DiagnosticTaskInternal) -> Any:
        status = self._make_status(task, DiagnosticStatus.ERROR, "No message was set")
        status.hardware_id = self.hwid
        status = task.run(status)
        if status is None:
            raise TypeError(f"the diagnostic task '{task.name}' must return the status that it was given")
        if self.verbose and status.level != DiagnosticStatus.OK:
            self.node.get_logger().warning(
                f"Non-zero diagnostic status. Name: {status.name}, status {status.level}: {status.message}"
            )
        return status

    @staticmethod
    def _make_status(task: DiagnosticTaskVector.DiagnosticTaskInternal, level: bytes, message: str) -> Any:
        status = DiagnosticStatusWrapper(name=task.name)
        status.summary(level, message)
        return status


def _declare_parameter(node: Any, name: str, default: Any) -> Any:
    """Return the value of a parameter, which a node that declares its overrides has already."""
    if not node.has_parameter(name):
        node.declare_parameter(name, default)
    return node.get_parameter(name).value
