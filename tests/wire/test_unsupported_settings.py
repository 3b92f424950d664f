"""Settings of ROS 2 that no transport supports."""

from __future__ import annotations

import pytest

from linkwright.cli import main
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Graph
from linkwright.graph.faults import RclError
from linkwright.standins.rclpy_api.context import Context
from linkwright.wire.joining import check_security, is_available, join
from linkwright.wire.unsupported_settings import find_new_unsupported_settings, find_unsupported_settings
from tests.domains import own_domain

SECURE = {"ROS_SECURITY_ENABLE": "true"}
ENFORCED = {**SECURE, "ROS_SECURITY_STRATEGY": "Enforce"}
SERVER = {"ROS_DISCOVERY_SERVER": "127.0.0.1:11811"}

with_network = pytest.mark.skipif(not is_available(), reason="neither DDS nor Zenoh is installed")


def diagnostic_codes(variables):
    return [setting.code for setting in find_unsupported_settings(variables)]


@pytest.mark.parametrize(
    ("variables", "message"),
    [
        ({}, []),
        (SECURE, ["DDS122"]),
        ({**SECURE, "ROS_SECURITY_STRATEGY": "Permissive"}, ["DDS122"]),
        ({"ROS_SECURITY_ENABLE": "false"}, []),
        ({"ROS_SECURITY_ENABLE": "True"}, []),  # rcl compares with "true"
        ({"ROS_SECURITY_STRATEGY": "Enforce"}, []),
        (SERVER, ["DDS123"]),
        ({**SERVER, "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}, ["DDS123"]),
        ({**SERVER, "RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}, []),
        ({**SERVER, "RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}, []),
        ({"ROS_DISCOVERY_SERVER": ""}, []),
        ({"ROS2_EASY_MODE": "192.0.2.7"}, ["DDS123"]),
        ({"RMW_IMPLEMENTATION": "rmw_zenoh"}, ["DDS124"]),
        ({"RMW_IMPLEMENTATION": "rmw_connextdds"}, []),
        ({"RMW_IMPLEMENTATION": " "}, []),
        ({**SECURE, **SERVER}, ["DDS122", "DDS123"]),
    ],
)
def test_unsupported_settings_are_reported(variables, message):
    assert diagnostic_codes(variables) == message


@pytest.mark.parametrize(
    "variables", [{}, SECURE, {"ROS_SECURITY_STRATEGY": "Enforce"}, {**ENFORCED, "LINKWRIGHT_DDS": "0"}]
)
def test_settings_without_enforced_security_are_accepted(variables):
    check_security(variables)


def test_join_is_rejected_if_security_is_enforced():
    graph = Graph(threads=True)
    try:
        with pytest.raises(LinkwrightError) as caught:
            join(graph, environment=ENFORCED)
    finally:
        graph.close_threadsafe()
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["DDS121"]


def test_setting_is_reported_once_per_process(monkeypatch):
    monkeypatch.setattr("linkwright.wire.unsupported_settings._reported", set())
    assert [setting.code for setting in find_new_unsupported_settings(SERVER)] == ["DDS123"]
    assert [setting.code for setting in find_new_unsupported_settings({**SERVER, **SECURE})] == ["DDS122"]


@with_network
def test_joining_graphs_log_unsupported_settings(monkeypatch):
    monkeypatch.setattr("linkwright.wire.unsupported_settings._reported", set())
    for name, value in SERVER.items():
        monkeypatch.setenv(name, value)
    log = []
    for _ in range(2):
        graph = Graph(threads=True, on_log=log.append)
        join(graph, domain_id=own_domain())
        graph.close_threadsafe()
    (text,) = [record.text for record in log]
    assert text.startswith("warning[DDS123]: ROS_DISCOVERY_SERVER is set")


def test_rclpy_init_fails_if_security_is_enforced(monkeypatch):
    for name, value in ENFORCED.items():
        monkeypatch.setenv(name, value)
    context = Context()
    with pytest.raises(RclError, match=r"failed to initialize rcl: .*ROS_SECURITY_STRATEGY is Enforce"):
        context.init([])
    assert not context.ok()


@pytest.mark.parametrize(
    "words", [["node", "list"], ["view", "--join", "--no-open", "r.urdf"], ["bridge", "dds", "zenoh"]]
)
def test_commands_report_enforced_security_once(monkeypatch, capsys, tmp_path, words):
    (tmp_path / "r.urdf").write_text("<robot name='r'><link name='a'/></robot>")
    monkeypatch.chdir(tmp_path)
    for name, value in ENFORCED.items():
        monkeypatch.setenv(name, value)
    assert main(words) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("error[DDS121]: ROS_SECURITY_STRATEGY is Enforce")
    assert err.count("error") == 1
