"""The choice of a process's transport."""

from __future__ import annotations

import importlib.util

import pytest

from linkwright.diagnostics import LinkwrightError, install_hint
from linkwright.graph import Graph
from linkwright.wire.dds import DdsTransport
from linkwright.wire.joining import check_settings, is_available, join, select_middleware, unavailable_reason
from linkwright.wire.unsupported_settings import CYCLONE, ZENOH
from linkwright.wire.zenoh import ZenohTransport

PLACES = ("linkwright.wire.joining", "linkwright.wire.dds.joining", "linkwright.wire.zenoh.joining")
REQUESTED_RMW = {"RMW_IMPLEMENTATION": ZENOH}


@pytest.fixture
def install_only(monkeypatch):
    """Return a function that makes only these packages appear installed."""

    def only(*names: str) -> None:
        def find_spec(name: str) -> object:
            return importlib.util.find_spec("linkwright") if name in names else None

        for place in PLACES:
            monkeypatch.setattr(f"{place}.find_spec", find_spec)

    return only


@pytest.mark.parametrize(
    ("packages", "variables", "chosen", "is_installed"),
    [
        (["cyclonedds", "zenoh", "xxhash"], {}, CYCLONE, True),
        (["cyclonedds", "zenoh", "xxhash"], REQUESTED_RMW, ZENOH, True),
        (["zenoh", "xxhash"], {}, ZENOH, True),
        (["zenoh", "xxhash"], {"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}, CYCLONE, False),
        (["cyclonedds"], REQUESTED_RMW, ZENOH, False),
        (["zenoh"], REQUESTED_RMW, ZENOH, False),
        ([], {}, CYCLONE, False),
        (["cyclonedds", "zenoh", "xxhash"], {**REQUESTED_RMW, "LINKWRIGHT_DDS": "0"}, ZENOH, False),
    ],
)
def test_rmw_implementation_selects_transport_before_installed_packages(
    install_only, packages, variables, chosen, is_installed
):
    install_only(*packages)
    assert select_middleware(variables) == chosen
    assert is_available(variables) is is_installed


def test_missing_packages_are_reported(install_only):
    install_only()
    assert f"neither DDS nor Zenoh is installed: {install_hint('zenoh')}, or with 'dds'" in unavailable_reason({})
    assert "the package 'eclipse-zenoh' is not installed" in unavailable_reason(REQUESTED_RMW)
    assert "the package 'cyclonedds' is not installed" in unavailable_reason({"RMW_IMPLEMENTATION": CYCLONE})


def test_process_without_transport_logs_and_continues(install_only):
    install_only()
    log = []
    graph = Graph(threads=True, on_log=log.append)
    try:
        assert join(graph, environment={}) is None
        assert join(graph, environment={"LINKWRIGHT_DDS": "0"}) is None
        (record,) = log
        assert record.text.startswith(
            "This process does not communicate with other processes: neither DDS nor Zenoh is installed"
        )
        assert graph.create_node("alone").get_node_names() == ["alone"]
    finally:
        graph.close_threadsafe()


@pytest.mark.skipif(importlib.util.find_spec("cyclonedds") is None, reason="cyclonedds is not installed")
def test_settings_of_chosen_transport_are_checked():
    invalid_variables = {"ZENOH_CONFIG_OVERRIDE": "mode"}
    check_settings(invalid_variables)
    with pytest.raises(LinkwrightError, match="is not a Zenoh setting"):
        check_settings({**REQUESTED_RMW, **invalid_variables})
    for variables in ({}, REQUESTED_RMW):
        with pytest.raises(LinkwrightError, match="is not a DDS domain"):
            check_settings({**variables, "ROS_DOMAIN_ID": "233"})


@pytest.mark.parametrize(("variables", "kind"), [({}, DdsTransport), (REQUESTED_RMW, ZenohTransport)])
def test_graph_joins_with_chosen_transport(variables, kind, domain):
    pytest.importorskip("cyclonedds" if kind is DdsTransport else "zenoh", reason="it is not installed here")
    graph = Graph(threads=True)
    try:
        transport = join(graph, environment={**variables, "ROS_DOMAIN_ID": str(domain)})
        assert isinstance(transport, kind)
        assert transport.domain_id == domain
        assert transport.wait_until_ready(60)
    finally:
        graph.close_threadsafe()
