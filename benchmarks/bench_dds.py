"""Measure the transport of joint states, transforms and images between two processes.

Linkwright over DDS is compared with Linkwright over Zenoh, with `cyclonedds` alone and its IdlStructs, and with
zenoh-ros2-sdk over Zenoh. Run it with ``python -m benchmarks dds``. Messages are received as objects, by Linkwright in
an event loop, as in the launcher.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys

from benchmarks import peers
from benchmarks.dds_sides import Result
from benchmarks.measure import ROOT, Row

DOMAIN = "67"
ROUNDS = 3
DURATION_S = 2.0
LIBRARIES = {"ours": "", "ours over Zenoh": "ours over Zenoh", "plain": "cyclonedds alone", "zenoh": "zenoh-ros2-sdk"}
"""Maps the key of a library to its name in the table."""


def measure(library: str, kind: str, rate: float) -> dict[str, float] | None:
    """Return the results of both sides, or None for a library that does not run here."""
    name, _, over = library.partition(" over ")
    words = (name, kind, str(DURATION_S), str(rate))
    middleware = "rmw_zenoh_cpp" if over == "Zenoh" else "rmw_cyclonedds_cpp"
    environment = {**os.environ, "ROS_DOMAIN_ID": DOMAIN, "RMW_IMPLEMENTATION": middleware}
    sides = [
        subprocess.Popen(
            [sys.executable, "-m", "benchmarks.dds_sides", side, *words],
            cwd=ROOT,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=None if name == "ours" else subprocess.DEVNULL,
            text=True,
        )
        for side in ("receive", "send")
    ]
    outputs = [side.communicate(timeout=90)[0].splitlines() for side in sides]
    if not all(outputs):
        return None
    received, sent = (Result(**json.loads(lines[-1])) for lines in outputs)
    return {
        "rate": received.count / max(received.seconds, 1e-9),
        "sending": 100.0 * sent.cores,
        "receiving": 100.0 * received.cores,
        "latency": 1e3 * received.latency,
        "lost": 100.0 * (sent.count - received.count) / sent.count,
    }


def measure_medians(kind: str, rate: float) -> dict[str, dict[str, float]]:
    """Return the medians of several runs of each library, in turns."""
    libraries = [name for name in LIBRARIES if name != "zenoh" or peers.get_version("zenoh_ros2_sdk") is not None]
    runs: dict[str, list[dict[str, float]]] = {library: [] for library in libraries}
    for _ in range(ROUNDS):
        for library in libraries:
            result = measure(library, kind, rate)
            if result is not None:
                runs[library].append(result)
    return {
        library: {name: statistics.median(run[name] for run in library_runs) for name in library_runs[0]}
        for library, library_runs in runs.items()
        if library_runs
    }


def make_rows(what: str, kind: str, rate: float, promised: str, share: str = "", *, aged: bool = False) -> list[Row]:
    """Return the rows of one kind of message.

    Args:
        what: the name of the kind in the table.
        kind: see `dds_sides`.
        rate: messages per second; 0 for as many as possible.
        promised: the rate.
        share: the share of a core that each side may use.
        aged: whether the age of received messages is measured.
    """
    results = measure_medians(kind, rate)

    def row(name: str, figure: str, unit: str, target: str) -> Row:
        beside = {
            title: results.get(library, {}).get(figure)
            for library, title in LIBRARIES.items()
            if title and not (figure == "latency" and library == "plain")
        }
        return Row(f"{what}{name}", results["ours"][figure], unit, target, dict(beside))

    rows = [row(", received", "rate", "1/s", promised)]
    if aged:
        rows.append(row(", from sender to callback", "latency", "ms", ""))
    if share or aged:
        rows += [
            row(", sender", "sending", "% of a core", share),
            row(", receiver", "receiving", "% of a core", share),
        ]
    return [*rows, row(", lost", "lost", "%", "0")]


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    return [
        *make_rows("JointState of 12 joints, unpaced", "joints", 0.0, "30000"),
        *make_rows("JointState of 12 joints at 1 kHz", "joints", 1000.0, "1000", aged=True),
        *make_rows("TF of 100 transforms at 500 Hz, as arrays", "transforms", 500.0, "500", "100"),
        *make_rows("TF of 100 transforms at 500 Hz, as objects", "objects", 500.0, "500", "100"),
        *make_rows("TF of 100 transforms, unpaced, as objects", "objects", 0.0, ""),
        *make_rows("images 640x480 RGB at 60 Hz", "images", 60.0, "60", "10", aged=True),
        *make_rows("images 640x480 RGB, unpaced", "images", 0.0, ""),
    ]
