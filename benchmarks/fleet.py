"""Measure what each additional robot costs on Zenoh.

Usage: ``python -m benchmarks.fleet [ROBOTS ...]``; by default with 50 and 100 robots.

Each robot is a graph with its own session, a client of one router; twenty-five robots share a process. A robot
publishes 5 transforms at 20 Hz, odometry at 20 Hz and a scan of 360 ranges at 10 Hz. One more session receives the
messages of all robots as bytes and counts them. Processor time and memory are those of all processes, and those of the
router alone.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import os
import socket
import subprocess
import sys
import time

import psutil

from benchmarks.measure import ROOT
from linkwright.graph import Graph
from linkwright.messages import get_message
from linkwright.wire.zenoh import join

DOMAIN = "68"
ROBOTS_PER_PROCESS = 25
DURATION_S = 10.0
TRANSFORM_COUNT = 5
RANGE_COUNT = 360
TICK_S = 0.05
SAMPLE_S = 4.0
TYPES = {"tf": "tf2_msgs/msg/TFMessage", "odom": "nav_msgs/msg/Odometry", "scan": "sensor_msgs/msg/LaserScan"}


async def drive(first: int, count: int) -> None:
    """Simulate a number of robots until standard input is closed."""
    tf, odometry, scan = (get_message(name) for name in TYPES.values())
    transform = get_message("geometry_msgs/msg/TransformStamped")
    publishers, graphs = [], []
    for number in range(first, first + count):
        graph = Graph()
        node = graph.create_node("robot", namespace=f"/robot{number}", start_parameter_services=False)
        publishers.append(
            [
                (node.create_publisher(tf, "tf", 100), tf(transforms=[transform() for _ in range(TRANSFORM_COUNT)]), 1),
                (node.create_publisher(odometry, "odom", 10), odometry(), 1),
                (node.create_publisher(scan, "scan", 10), scan(ranges=[1.0] * RANGE_COUNT), 2),
            ]
        )
        transport = join(graph)
        assert transport is not None
        assert await asyncio.to_thread(transport.wait_until_ready, 60.0), transport.problem
        graphs.append(graph)
    print("ready", flush=True)
    stop = asyncio.get_running_loop().run_in_executor(None, sys.stdin.read)
    for tick in itertools.count():
        begin = time.monotonic()
        for robot in publishers:
            for publisher, message, ticks_per_message in robot:
                if tick % ticks_per_message == 0:
                    publisher.publish(message)
        if stop.done():
            break
        await asyncio.sleep(max(0.0, TICK_S - (time.monotonic() - begin)))
    for graph in graphs:
        await graph.close()


async def listen(robots: int) -> None:
    """Count the messages of a number of robots between two lines of standard input."""
    graph = Graph()
    counts = dict.fromkeys(TYPES, 0)
    node = graph.create_node("listener")
    for number, (topic, type_name) in itertools.product(range(robots), TYPES.items()):

        def count(_message: object, topic: str = topic) -> None:
            counts[topic] += 1

        node.create_subscription(type_name, f"/robot{number}/{topic}", count, 100, raw=True)
    transport = join(graph)
    assert transport is not None
    await asyncio.to_thread(transport.wait_until_ready, 60.0)
    while len(node.get_node_names()) <= robots:  # noqa: ASYNC110 - the graph tells its changes to threads alone
        await asyncio.sleep(0.2)
    print("ready", flush=True)
    await asyncio.to_thread(sys.stdin.readline)
    old_counts = dict(counts)
    await asyncio.to_thread(sys.stdin.readline)
    heard = {topic: counts[topic] - old_counts[topic] for topic in counts}
    print(json.dumps({"heard": heard, "nodes": len(node.get_node_names())}), flush=True)
    await graph.close()


def measure(robots: int) -> dict[str, float]:
    """Return the cost of a number of robots."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
    endpoints = f'["tcp/127.0.0.1:{port}"]'
    router_settings = f"listen/endpoints={endpoints};connect/endpoints=[]"
    session_settings = (
        f'mode="client";connect/endpoints={endpoints};listen/endpoints=[];scouting/multicast/enabled=false'
    )
    common = {**os.environ, "ROS_DOMAIN_ID": DOMAIN}

    def start(settings: str, *words: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, "-m", *words],
            cwd=ROOT,
            env={**common, "ZENOH_CONFIG_OVERRIDE": settings},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    with contextlib.ExitStack() as ending:
        router = start(router_settings, "linkwright.node_program", "rmw_zenoh_cpp", "rmw_zenohd")
        ending.callback(router.kill)
        time.sleep(3.0)
        parts = [
            start(
                session_settings, "benchmarks.fleet", "drive", str(first), str(min(ROBOTS_PER_PROCESS, robots - first))
            )
            for first in range(0, robots, ROBOTS_PER_PROCESS)
        ]
        listener = start(session_settings, "benchmarks.fleet", "listen", str(robots))
        begin = time.monotonic()
        for part in (*parts, listener):
            ending.callback(part.kill)
            assert part.stdout is not None
            assert part.stdout.readline() == "ready\n"
        joined = time.monotonic() - begin
        used = {part.pid: psutil.Process(part.pid) for part in (router, *parts)}
        discovery = settle(used)
        assert listener.stdin is not None
        print(file=listener.stdin, flush=True)
        start_times = get_processor_times(used)
        time.sleep(DURATION_S)
        processor_times = {pid: seconds - start_times[pid] for pid, seconds in get_processor_times(used).items()}
        memory = {pid: process.memory_info().rss / 1e6 for pid, process in used.items()}
        heard = json.loads(listener.communicate("\n")[0])
    return {
        "robots": robots,
        "joined within, s": joined,
        "processor until all is discovered, s": discovery,
        "processor of a robot, % of a core": 100
        * (sum(processor_times.values()) - processor_times[router.pid])
        / DURATION_S
        / robots,
        "router for a robot, % of a core": 100 * processor_times[router.pid] / DURATION_S / robots,
        "memory of a robot, MB": (sum(memory.values()) - memory[router.pid]) / robots,
        "router for a robot, MB": memory[router.pid] / robots,
        "nodes seen": heard["nodes"],
        **{f"{topic} a second of a robot": count / DURATION_S / robots for topic, count in heard["heard"].items()},
    }


def get_processor_times(used: dict[int, psutil.Process]) -> dict[int, float]:
    """Return the processor time of each process in seconds."""
    return {pid: sum(process.cpu_times()[:2]) for pid, process in used.items()}


def settle(used: dict[int, psutil.Process]) -> float:
    """Wait until the traffic of discovery has settled, and return the traffic until then."""
    old_total, last_increase = sum(get_processor_times(used).values()), float("inf")
    while True:
        time.sleep(SAMPLE_S)
        total = sum(get_processor_times(used).values())
        if total - old_total >= 0.8 * last_increase:
            return old_total
        old_total, last_increase = total, total - old_total


def main() -> None:
    """Run the measurement, or one of its processes."""
    words = sys.argv[1:]
    if words[:1] == ["drive"]:
        asyncio.run(drive(int(words[1]), int(words[2])))
    elif words[:1] == ["listen"]:
        asyncio.run(listen(int(words[1])))
    else:
        for robots in [int(word) for word in words] or [50, 100]:
            print(json.dumps({name: round(value, 3) for name, value in measure(robots).items()}), flush=True)


if __name__ == "__main__":
    main()
