"""Joining a domain: settings, missing packages and errors."""

from __future__ import annotations

import socket
import subprocess
import sys
from contextlib import ExitStack, suppress

import pytest

from linkwright.graph import Graph, LogRecord
from linkwright.messages import String
from linkwright.wire.dds import is_available, join, unavailable_reason
from linkwright.wire.dds.settings import max_participants
from linkwright.wire.domain_id import MAX_DOMAIN_ID

with_dds = pytest.mark.skipif(not is_available(), reason="cyclonedds is not installed")


@pytest.fixture
def log() -> list[LogRecord]:
    return []


@pytest.fixture
def graph(log):
    graph = Graph(threads=True, on_log=log.append)
    yield graph
    graph.close_threadsafe()


def log_texts(log):
    return [record.text for record in log]


def delivers_locally(graph) -> bool:
    messages = []
    node = graph.create_node("alone")
    node.create_subscription(String, "chatter", messages.append, 10)
    node.create_publisher(String, "chatter", 10).publish(String())
    return graph.count_publishers("/chatter") == 1


def test_import_does_not_load_cyclonedds():
    code = "import sys, linkwright.wire.dds; print('cyclonedds' in sys.modules)"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout == "False\n"


def test_linkwright_dds_0_keeps_process_offline(graph, log, monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    assert not is_available()
    assert unavailable_reason() == "the environment variable LINKWRIGHT_DDS is 0"
    assert join(graph) is None
    assert log == []
    assert delivers_locally(graph)


def test_missing_cyclonedds_is_reported_and_process_continues(graph, log, monkeypatch):
    monkeypatch.setattr("linkwright.wire.dds.joining.find_spec", lambda _name: None)
    assert "'cyclonedds' is not installed" in unavailable_reason()
    assert join(graph) is None
    (text,) = log_texts(log)
    assert text.startswith(
        "This process does not communicate with other processes: the package 'cyclonedds' is not installed"
    )
    assert delivers_locally(graph)


@with_dds
@pytest.mark.parametrize("number", ["233", "-1", "one", "1.5"])
def test_invalid_domain_id_is_reported(graph, log, monkeypatch, number):
    monkeypatch.setenv("ROS_DOMAIN_ID", number)
    assert join(graph) is None
    (text,) = log_texts(log)
    assert f"error[DDS101]: '{number}' is not a DDS domain ID" in text
    assert "This process continues without the network" in text
    assert delivers_locally(graph)


@with_dds
@pytest.mark.parametrize("uri", ["file:///no/such/file.xml", "<CycloneDDS><Nonsense/></CycloneDDS>", "<Cyclone"])
def test_configuration_rejected_by_cyclone_is_reported(graph, log, monkeypatch, uri, capfd):
    monkeypatch.setenv("CYCLONEDDS_URI", uri)
    transport = join(graph)
    assert not transport.wait_until_ready(10)
    assert transport.problem.diagnostics[0].code == "DDS102"
    (text,) = log_texts(log)
    assert uri in text
    assert delivers_locally(graph)
    capfd.readouterr()


@with_dds
def test_invalid_discovery_range_is_reported_and_falls_back_to_machine(graph, log, monkeypatch):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOTS")
    transport = join(graph)
    assert transport.wait_until_ready(60)
    (text,) = log_texts(log)
    assert text.startswith("Invalid value 'LOCALHOTS' specified for 'ROS_AUTOMATIC_DISCOVERY_RANGE'")
    assert "did you mean 'LOCALHOST'?" in text


@with_dds
def test_domain_without_free_ports_is_reported(graph, log, domain, capfd):
    with ExitStack() as stack:
        for index in range(max_participants(domain) + 1):
            udp_socket = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            with suppress(OSError):
                udp_socket.bind(("", 7410 + 250 * domain + 2 * index))
        transport = join(graph)
        assert not transport.wait_until_ready(10)
    assert transport.problem.diagnostics[0].code == "DDS103"
    assert delivers_locally(graph)
    capfd.readouterr()


@with_dds
def test_highest_domain_id_can_be_joined(graph, monkeypatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", str(MAX_DOMAIN_ID))
    transport = join(graph)
    assert transport.wait_until_ready(60), transport.problem
