"""Run several processes for an hour, and check that nothing grows, gets lost or hangs.

Usage: ``python -m benchmarks.soak [--minutes 60]``

Programs with rclpy publish at several rates, call services, actions and parameters, and create and destroy nodes. A
launch has a process that is killed with SIGKILL and restarted. Commands inspect the graph from outside. At the end, a
table shows memory, threads and file descriptors of each process, and lost messages. The exit status is 1 if a limit is
exceeded.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import psutil

from benchmarks.measure import LINKWRIGHT, ROOT

PARTS = ("listener", "talker", "server", "client", "guests")
SAMPLE_PERIOD_S = 2.0
KILL_PERIOD_S = 15.0
COMMAND_PERIOD_S = 12.0
RESTART_TIMEOUT_S = 8.0
"""The seconds within which messages of a killed process's successor must arrive."""

MAX_GROWTH_MB = 5.0
MAX_GROWTH_SHARE = 0.05
"""The permitted growth of memory after the warm-up: the larger of the two values.

It is not 0 because Cyclone keeps some hundred bytes of each deleted reader or writer, even without Linkwright.
"""

MAX_HANDLE_INCREASE = 3
"""The permitted increase of threads and of file descriptors after the warm-up."""

MAX_P99_MS = 100.0
COMMANDS = (
    ("topic", "list", "-t"),
    ("topic", "echo", "/soak/rate_50", "--once"),
    ("node", "list"),
    ("service", "call", "/soak/add", "example_interfaces/srv/AddTwoInts", "{a: 1, b: 2}"),
    ("param", "get", "/soak_server", "speed"),
    ("node", "info", "/soak_listener"),
)
LAUNCH = """
import sys
from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch.substitutions import Command, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    model = PathJoinSubstitution([FindPackageShare("my_robot_description"), "urdf", "mbot_base.urdf"])
    return LaunchDescription([
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{"robot_description": ParameterValue(Command(["cat ", model]), value_type=str)}]),
        Node(package="joint_state_publisher", executable="joint_state_publisher"),
        Node(package="rviz2", executable="rviz2"),
        ExecuteProcess(cmd=[sys.executable, "-m", "benchmarks.soak_parts", "victim"], respawn=True),
    ])
"""


@dataclass
class WatchedProcess:
    """A process and its observed figures.

    Attributes:
        name: the role of the process.
        process: the running process.
        errors: the file of its standard error.
        samples: (seconds since the start, MB of its own memory, threads, file descriptors).
        report: the last line of JSON that it printed.
        delays: 99th percentiles of its latencies, ms.
    """

    name: str
    process: subprocess.Popen[str]
    errors: Path
    samples: list[tuple[float, float, int, int]] = field(default_factory=list)
    report: dict[str, Any] = field(default_factory=dict)
    delays: list[float] = field(default_factory=list)

    def sample(self, since: float) -> None:
        """Add a sample of its memory, threads and file descriptors."""
        with suppress(psutil.Error):
            watched_process = psutil.Process(self.process.pid)
            known = watched_process.memory_info()
            # The system loads and drops pages of files, such as libraries, at any time.
            memory = (known.rss - getattr(known, "shared", 0)) / 1e6
            self.samples.append(
                (time.monotonic() - since, memory, watched_process.num_threads(), watched_process.num_fds())
            )

    def listen(self) -> None:
        """Read its output until it ends, and store the figures in it."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            with suppress(ValueError):
                self.report = json.loads(line)
                if "p99_ms" in self.report:
                    self.delays.append(self.report["p99_ms"])

    def get_count(self, what: str) -> int:
        """Return the last reported value of a counter."""
        return int(self.report.get("seen", {}).get(what, 0))


class Soak:
    """A run of the soak.

    Args:
        seconds: the duration of the run.
        warm_up: the seconds after which memory, threads and file descriptors must not grow.
        domain: the DDS domain.
    """

    def __init__(self, seconds: float, warm_up: float, domain: str) -> None:
        from linkwright.standins.process import create_environment

        self._seconds, self._warm_up = seconds, warm_up
        self._environment = {**create_environment(os.environ), "ROS_DOMAIN_ID": domain}
        self._watched: list[WatchedProcess] = []
        self.faults: list[str] = []
        self._kills = self._commands = 0
        self._begin = time.monotonic()

    def run(self) -> int:
        """Run the processes, print the table, and return the exit status."""
        with tempfile.TemporaryDirectory() as folder, self._processes(Path(folder)):
            self._begin = time.monotonic()
            helpers = [
                threading.Thread(target=work, daemon=True) for work in (self._kill_repeatedly, self._run_commands)
            ]
            for helper in helpers:
                helper.start()
            while (passed := time.monotonic() - self._begin) < self._seconds:
                time.sleep(SAMPLE_PERIOD_S)
                for watched in self._watched:
                    watched.sample(self._begin)
                self._sample_processes(passed)
            for helper in helpers:
                helper.join(60.0)
        self._judge()
        self._print()
        return 1 if self.faults else 0

    def samples(self) -> dict[str, list[tuple[float, float, int, int]]]:
        """Return the samples of each process: seconds, MB, threads, file descriptors."""
        return {watched.name: watched.samples for watched in self._watched}

    @contextmanager
    def _processes(self, folder: Path) -> Iterator[None]:
        launch = folder / "soak.launch.py"
        launch.write_text(LAUNCH, encoding="utf-8")
        words = [LINKWRIGHT, "launch", str(launch), "--no-open"]
        self._start("launcher", words, {"PYTHONUNBUFFERED": "1", "ROS_LOG_DIR": str(folder)})
        for part in PARTS:
            self._start(part, [sys.executable, "-m", "benchmarks.soak_parts", part], {"ROS_LOG_DIR": str(folder)})
        try:
            yield
        finally:
            # End the talker first, and wait for messages on their way: the listener must receive all of them.
            for watched in sorted(self._watched, key=lambda watched: watched.name != "talker"):
                self._end(watched)
                if watched.name == "talker":
                    time.sleep(4.0)

    def _start(self, name: str, words: list[str], more: Mapping[str, str]) -> None:
        environment = {**self._environment, **more}
        errors = Path(more["ROS_LOG_DIR"], f"{name}-errors")
        with errors.open("w") as stream:
            process = subprocess.Popen(
                words, cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=stream, text=True
            )
        watched = WatchedProcess(name, process, errors)
        threading.Thread(target=watched.listen, daemon=True).start()
        self._watched.append(watched)

    def _end(self, watched: WatchedProcess) -> None:
        descendants = _find_descendants(watched.process.pid)
        if watched.process.poll() is not None:
            self.faults.append(f"{watched.name} had ended with status {watched.process.returncode}")
            return
        watched.process.send_signal(signal.SIGINT)
        try:
            status = watched.process.wait(10.0)
        except subprocess.TimeoutExpired:
            self.faults.append(f"{watched.name} did not end within 10 s")
            watched.process.kill()
            watched.process.wait()
            return
        if status != (130 if watched.name == "launcher" else 0):
            self.faults.append(f"{watched.name} ended with status {status}")
        _, left = psutil.wait_procs(descendants, timeout=3.0)
        for orphan in left:
            self.faults.append(f"{watched.name} left process {orphan.pid} behind")
            orphan.kill()

    def _is_over(self) -> bool:
        return time.monotonic() - self._begin > self._seconds - RESTART_TIMEOUT_S

    def _kill_repeatedly(self) -> None:
        """Kill the launch's process repeatedly, and wait for messages of its successor."""
        launcher, listener = self._find_process("launcher"), self._find_process("listener")
        while not self._is_over():
            time.sleep(KILL_PERIOD_S)
            victims = [
                process for process in _find_descendants(launcher.process.pid) if "victim" in _get_command_line(process)
            ]
            if len(victims) != 1:
                self.faults.append(f"{len(victims)} processes are there to be killed instead of one")
                continue
            victims[0].kill()
            self._kills += 1
            time.sleep(1.0)
            heard, limit = listener.get_count("/soak/phoenix"), time.monotonic() + RESTART_TIMEOUT_S
            while listener.get_count("/soak/phoenix") <= heard:
                if time.monotonic() > limit:
                    self.faults.append(f"what was killed was not heard again within {RESTART_TIMEOUT_S:g} s")
                    break
                time.sleep(0.2)

    def _run_commands(self) -> None:
        """Run commands that inspect the graph, in turn."""
        while not self._is_over():
            words = COMMANDS[self._commands % len(COMMANDS)]
            self._commands += 1
            try:
                result = subprocess.run(
                    [LINKWRIGHT, *words],
                    env=self._environment,
                    capture_output=True,
                    text=True,
                    timeout=20,
                    check=False,
                )
                if result.returncode != 0:
                    self.faults.append(f"'{' '.join(words)}' ended with {result.returncode}: {result.stderr.strip()}")
            except subprocess.TimeoutExpired:
                self.faults.append(f"'{' '.join(words)}' did not end within 20 s")
            time.sleep(COMMAND_PERIOD_S)

    def _sample_processes(self, passed: float) -> None:
        for watched in self._watched:
            if watched.process.poll() is not None:
                error_text = watched.errors.read_text()[-2000:]
                raise SystemExit(
                    f"{error_text}\n{watched.name} ended with {watched.process.returncode} after {passed:.0f} s"
                )
        if sys.stderr.isatty():
            listener = self._find_process("listener")
            text = (
                f"{passed:6.0f} s, {listener.get_count('/soak/rate_1000')} messages, {listener.get_count('lost')} lost"
            )
            print(f"\r{text}, {self._kills} kills, {len(self.faults)} faults", end="", file=sys.stderr)

    def _find_process(self, name: str) -> WatchedProcess:
        return next(watched for watched in self._watched if watched.name == name)

    def _judge(self) -> None:
        talker, listener = self._find_process("talker"), self._find_process("listener")
        for watched in self._watched:
            for failure in watched.report.get("failures", ()):
                self.faults.append(f"{watched.name}: {failure}")
            growth = _compute_growth(watched, self._warm_up)
            if growth is not None:
                self._judge_growth(watched, growth)
        for name, count in talker.report.get("seen", {}).items():
            if listener.get_count(name) != count:
                self.faults.append(f"of {count} messages of {name} the last that came was {listener.get_count(name)}")
        if not listener.delays or statistics.median(listener.delays) > MAX_P99_MS:
            self.faults.append(f"latency: 99 of 100 messages come within more than {MAX_P99_MS:g} ms")
        for name, what in (("client", "sums"), ("client", "goals"), ("listener", "transforms"), ("guests", "guests")):
            if not self._find_process(name).get_count(what):
                self.faults.append(f"{name} has no {what}")

    def _judge_growth(self, watched: WatchedProcess, growth: Growth) -> None:
        if growth.megabytes > max(MAX_GROWTH_MB, MAX_GROWTH_SHARE * growth.last_megabytes):
            self.faults.append(f"{watched.name}: memory grew by {growth.megabytes:.1f} MB")
        if growth.threads > MAX_HANDLE_INCREASE:
            self.faults.append(f"{watched.name}: {growth.threads:g} threads more")
        if growth.descriptors > MAX_HANDLE_INCREASE:
            self.faults.append(f"{watched.name}: {growth.descriptors:g} file descriptors more")

    def _print(self) -> None:
        print(f"{'process':10} {'memory':>9} {'growth':>9} {'slope':>11} {'threads':>9} {'files':>8}  seen")
        for watched in self._watched:
            growth = _compute_growth(watched, self._warm_up)
            if growth is None:
                print(f"{watched.name:10} too short a run to tell")
                continue
            counts = ", ".join(
                f"{name.rpartition('/')[2]} {count}" for name, count in watched.report.get("seen", {}).items()
            )
            print(
                f"{watched.name:10} {growth.last_megabytes:6.1f} MB "
                f"{growth.megabytes:+6.2f} MB {growth.slope:+6.2f} MB/h "
                f"{growth.last_threads:4.0f}{growth.threads:+5.0f} "
                f"{growth.last_descriptors:4.0f}{growth.descriptors:+4.0f}  {counts}"
            )
        delays = self._find_process("listener").delays
        latency = f"99 of 100 messages within {statistics.median(delays):.2f} ms (median of 2 s)" if delays else "-"
        print(f"{self._seconds / 60:.1f} minutes, {self._kills} kills, {self._commands} commands; {latency}")
        for fault in self.faults:
            print(f"FAULT: {fault}")
        print("nothing lost, nothing grows" if not self.faults else f"{len(self.faults)} faults")


@dataclass(frozen=True)
class Growth:
    """The changes of a process from the end of the warm-up to the end of the run.

    Each value is a median over a fifth of this time.
    """

    megabytes: float
    slope: float
    threads: float
    descriptors: float
    last_megabytes: float
    last_threads: float
    last_descriptors: float


def _compute_growth(watched: WatchedProcess, warm_up: float) -> Growth | None:
    samples = [sample for sample in watched.samples if sample[0] >= warm_up]
    share = len(samples) // 5
    if share < 2:
        return None

    def medians(part: list[tuple[float, float, int, int]]) -> list[float]:
        return [statistics.median(column) for column in zip(*part, strict=True)]

    first, last = medians(samples[:share]), medians(samples[-share:])
    slope = (last[1] - first[1]) / (last[0] - first[0]) * 3600
    return Growth(last[1] - first[1], slope, last[2] - first[2], last[3] - first[3], last[1], last[2], last[3])


def _find_descendants(pid: int) -> list[psutil.Process]:
    with suppress(psutil.Error):
        return psutil.Process(pid).children(recursive=True)
    return []


def _get_command_line(process: psutil.Process) -> list[str]:
    with suppress(psutil.Error):
        return process.cmdline()
    return []


def main() -> int:
    """Read the arguments and run."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.soak", description=__doc__)
    parser.add_argument("--minutes", type=float, default=60.0, help="how long (default 60)")
    parser.add_argument("--warm-up", type=float, metavar="MINUTES", help="default: a fifth of it, at most 5")
    parser.add_argument("--samples", type=Path, metavar="FILE", help="keep what was seen of each process, as JSON")
    parser.add_argument("--domain", default="96", help="the DDS domain (default 96)")
    arguments = parser.parse_args()
    warm_up = min(5.0, arguments.minutes / 5.0) if arguments.warm_up is None else arguments.warm_up
    soak = Soak(arguments.minutes * 60.0, warm_up * 60.0, arguments.domain)
    status = soak.run()
    if arguments.samples is not None:
        arguments.samples.write_text(json.dumps(soak.samples()), encoding="utf-8")
    return status


if __name__ == "__main__":
    sys.exit(main())
