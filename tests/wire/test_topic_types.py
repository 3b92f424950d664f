"""The types of topics.

They are announced by name, created once per domain, and kept until the domain is closed.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
import textwrap

import pytest

from linkwright.messages import String, get_message
from linkwright.wire.dds import open_domains as opened
from linkwright.wire.dds.cyclone import CycloneError
from linkwright.wire.dds.topic_types import _table_without_descriptions

pytest.importorskip("cyclonedds.idl", reason="cyclonedds is not installed")
Point = get_message("geometry_msgs/msg/Point")

CHURN_PROGRAM = """
    import gc, time
    from linkwright.graph import Graph
    from linkwright.wire.dds import join
    from linkwright.messages import String, get_message

    Point = get_message("geometry_msgs/msg/Point")

    def process(name):
        graph = Graph(threads=True)
        assert join(graph).wait_until_ready(60)
        return graph, graph.create_node(name)

    def memory():
        gc.collect()
        return int(open("/proc/self/statm").read().split()[1]) * 4096 / 1e6

    first, node = process("first")
    publisher = node.create_publisher(Point, "/points", 10)  # the first type whose samples are known here
    other, listener = process("other")
    got = []
    listener.create_subscription(Point, "/points", got.append, 10)
    listener.create_subscription(String, "/words", print, 10)
    answering = listener.create_publisher(String, "/answers", 10)
    while not publisher.get_subscription_count():
        time.sleep(0.01)
    publisher.publish(Point())
    first.close_threadsafe()  # and its type with it, were it not kept
    for number in range(24):
        graph, node = process("next")
        words = node.create_publisher(String, "/words", 10)
        node.create_subscription(String, "/answers", print, 10)
        while not (words.get_subscription_count() and answering.get_subscription_count()):
            time.sleep(0.005)
        for _ in range(20):
            words.publish(String(data="word"))
            answering.publish(String(data="answer"))
        graph.close_threadsafe()
        if number == 3:
            before = memory()
    print(f"{memory() - before:.1f}")
    other.close_threadsafe()
"""


COMBINED_PROGRAM = """
    from linkwright.graph import Graph
    from linkwright.wire.dds import join
    from linkwright.messages import get_message

    NAMES = ["sensor_msgs/msg/Image", "sensor_msgs/msg/PointCloud2", "nav_msgs/msg/Odometry", "nav_msgs/msg/Path"]
    NAMES += ["visualization_msgs/msg/MarkerArray", "trajectory_msgs/msg/JointTrajectory", "tf2_msgs/msg/TFMessage"]

    def graph(name, types):
        graph = Graph(threads=True)
        node = graph.create_node(name)
        for type_name in types:
            node.create_publisher(get_message(type_name), f"/{name}/{type_name}", 1)
        return graph

    for _ in range(120):
        graphs = [graph("one", NAMES), graph("other", reversed(NAMES))]
        for transport in [join(joined) for joined in graphs]:
            assert transport.wait_until_ready(60)
        for joined in graphs:
            joined.close_threadsafe()
"""


def run_program(program: str) -> str:
    """Run a program, and return its output.

    It must end well although freed memory is overwritten.
    """
    result = subprocess.run(
        [sys.executable, "-X", "faulthandler", "-c", textwrap.dedent(program)],
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
        env={**os.environ, "MALLOC_PERTURB_": "165"},
    )
    assert (result.returncode, result.stderr) == (0, "")
    return result.stdout


@pytest.fixture
def shared(processes, domain):
    """Return the domain that two graphs of this process share."""
    processes("a"), processes("b")
    return opened._opened[domain]


def test_graphs_share_types_of_their_domain(shared, processes):
    for name in ("c", "d"):
        processes(name).node.create_publisher(String, "chatter", 10)
    assert shared.users == 4
    description = shared.descriptions.message(String)
    processes("e").spin_until(lambda: description in shared.types._type_addresses)
    address = shared.types._type_addresses[description]
    last = processes("f")
    last.node.create_subscription(String, "chatter", print, 10)
    last.spin_until(lambda: last.node.count_subscribers("/chatter") and last.node.count_publishers("/chatter") == 2)
    assert shared.types._type_addresses[description] == address


def test_type_outlives_its_last_topic(shared, processes):
    description = shared.descriptions.message(Point)
    a = processes("short")
    a.node.create_publisher(Point, "points", 10)
    a.spin_until(lambda: description in shared.types._type_addresses)
    a.close()
    assert description in shared.types._type_addresses


def test_closed_domain_frees_types(processes, domain):
    process = processes("alone")
    process.node.create_publisher(String, "chatter", 10)
    process.spin_until(lambda: domain in opened._opened and len(opened._opened[domain].types._type_addresses) > 1)
    types = opened._opened[domain].types
    process.close()
    assert domain not in opened._opened
    assert types._type_addresses == {}


def test_type_description_functions_are_omitted(shared, processes):
    processes("c").node.create_publisher(String, "chatter", 10)
    for address in tuple(shared.types._type_addresses.values()):
        table = ctypes.c_void_p.from_address(address).value
        functions = (ctypes.c_void_p * 12).from_address(table)
        assert list(functions[8:11]) == [None, None, None]
        assert all(functions[index] for index in (0, 2, 3, 4, 5, 6, 7, 11))


def test_function_table_of_other_version_is_kept():
    table = (ctypes.c_void_p * 14)(*range(100, 114))
    assert _table_without_descriptions(ctypes.addressof(table)) == ctypes.addressof(table)


def test_topic_rejected_by_cyclone_raises_error(processes):
    process = processes("ours")
    participant = process.transport._engine._participant
    with pytest.raises(CycloneError, match="topic 'not a name'"):
        participant.create_topic("not a name", participant.types.message(String))


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the test reads /proc")
def test_repeated_graphs_do_not_leak_memory(domain):
    assert float(run_program(CHURN_PROGRAM)) < 3.0, "creating the types again would take 0.5 MB per graph"


@pytest.mark.slow
def test_graphs_can_join_simultaneously(domain):
    assert run_program(COMBINED_PROGRAM) == ""
