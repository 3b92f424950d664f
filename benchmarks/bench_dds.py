"""What the wire costs: two processes on this machine, joint states, transforms and images.

Beside us: `cyclonedds` alone, and for joint states `zenoh-ros2-sdk`, which has a router between the two.
Run it with ``python -m benchmarks dds``. Messages are received as objects, in an event loop as the launcher's.
"""

from __future__ import annotations

import json
import os
import socket
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from benchmarks import peers
from benchmarks.dds_sides import Result
from benchmarks.measure import ROOT, Row
from linkwright.messages import definition_text, get_message, type_hash

DOMAIN = "67"
ROUNDS = 3
SECONDS = 2.0


def measured(library: str, kind: str, rate: float) -> tuple[Result, Result]:
    """What the sender and the receiver found."""
    words = (library, kind, str(SECONDS), str(rate))
    environment = {**os.environ, "ROS_DOMAIN_ID": DOMAIN}
    sides = [
        subprocess.Popen(
            [sys.executable, "-m", "benchmarks.dds_sides", side, *words],
            cwd=ROOT,
            env=environment,
            stdout=subprocess.PIPE,
            text=True,
        )
        for side in ("receive", "send")
    ]
    received, sent = (Result(**json.loads(each.communicate(timeout=90)[0].splitlines()[-1])) for each in sides)
    return sent, received


def medians(kind: str, rate: float, libraries: Sequence[str] = ("ours", "plain")) -> dict[str, dict[str, float]]:
    """The medians of several runs of each library, in turns."""
    runs: dict[str, list[dict[str, float]]] = {library: [] for library in libraries}
    for _ in range(ROUNDS):
        for library in libraries:
            sent, received = measured(library, kind, rate)
            runs[library].append(
                {
                    "rate": received.count / max(received.seconds, 1e-9),
                    "sending": sent.cores,
                    "receiving": received.cores,
                    "lost": 100.0 * (sent.count - received.count) / sent.count,
                }
            )
    return {
        library: {name: statistics.median(run[name] for run in found) for name in found[0]}
        for library, found in runs.items()
    }


def through_zenoh() -> float | None:
    """Joint states a second that `zenoh-ros2-sdk` receives; None where it is not installed or does not run."""
    if peers.version("zenoh_ros2_sdk") is None:
        return None
    with socket.socket() as asking, tempfile.TemporaryDirectory() as folder:
        asking.bind(("127.0.0.1", 0))
        port = asking.getsockname()[1]
        asking.close()
        description = Path(folder) / "type.json"
        description.write_text(json.dumps(_described("sensor_msgs/msg/JointState")), encoding="utf-8")
        words = (str(port), str(description), str(SECONDS))
        with _zenoh("router", *words) as router, _zenoh("receive", *words) as receiver:
            subprocess.run(_command("send", *words), check=False, capture_output=True, timeout=60)
            try:
                received = Result(**json.loads(receiver.communicate(timeout=60)[0].splitlines()[-1]))
            except (ValueError, IndexError, subprocess.TimeoutExpired):
                receiver.kill()
                return None
            finally:
                router.kill()
    return received.count / received.seconds


def _command(*words: str) -> list[str]:
    return [str(peers.FOLDER / "bin" / "python"), str(Path(__file__).with_name("dds_zenoh.py")), *words]


def _zenoh(*words: str) -> subprocess.Popen[str]:
    """A process of the peer, once it says that it is ready."""
    process = subprocess.Popen(
        _command(*words), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    assert process.stdout is not None
    process.stdout.readline()
    return process


def _described(type_name: str) -> tuple[str, str]:
    """A definition with those of its parts behind it, as bags have them, and the hash."""
    parts = [type_name]
    for name in parts:
        fields = get_message(name)._definition.fields
        parts += [field.type.base for field in fields if "/" in field.type.base and field.type.base not in parts]
    texts = [definition_text(get_message(name)) for name in parts]
    behind = (f"{'=' * 80}\nMSG: {name.replace('/msg/', '/')}\n{text}" for name, text in zip(parts, texts, strict=True))
    next(behind)
    return "\n".join([texts[0], *behind]), type_hash(get_message(type_name))


def rows() -> list[Row]:
    """The table."""
    table = []

    def row(what: str, found: dict[str, dict[str, float]], name: str, unit: str, target: str = "") -> None:
        scale = 1.0 if unit in ("1/s", "%") else 100.0
        ours, plain = found["ours"][name] * scale, found.get("plain", {}).get(name)
        beside = {} if plain is None or not ours else {"cyclonedds alone": plain * scale}
        table.append(Row(what, ours, "%" if unit == "cores" else unit, target, dict(beside)))

    joints = medians("joints", 0.0)
    row("joint states of 12 joints, unpaced, received", joints, "rate", "1/s", "30000")
    table[-1].peers["zenoh-ros2-sdk"] = through_zenoh()
    row("of these lost", joints, "lost", "%", "0")
    transforms = medians("transforms", 500.0)
    row("100 transforms at 500 Hz, received", transforms, "rate", "1/s", "500")
    row("their sender's share of a core", transforms, "sending", "cores", "under 100")
    row("their receiver's share of a core", transforms, "receiving", "cores", "under 100")
    images = medians("images", 60.0, ("ours",))
    row("images 640x480 RGB at 60 Hz, received", images, "rate", "1/s", "60")
    row("their sender's share of a core", images, "sending", "cores", "under 10")
    row("their receiver's share of a core", images, "receiving", "cores", "under 10")
    row("images lost", images, "lost", "%", "0")
    flood = medians("images", 0.0, ("ours",))
    row("images, unpaced, received", flood, "rate", "1/s")
    row("of these lost", flood, "lost", "%", "0")
    return table
