"""`linkwright bridge`: its arguments, and the errors that it reports."""

from __future__ import annotations

import pytest

from linkwright.cli.command import main


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("dds", "ros1"), "CLI451"),
        (("dds:", "zenoh"), "CLI451"),
        (("zenoh", "zenoh"), "CLI452"),
        (("dds", "dds:7"), "CLI452"),
        (("dds:no", "zenoh"), "DDS101"),
        (("dds:233", "zenoh"), "DDS101"),
        (("dds", "zenoh", "--allow", "scan"), "CLI453"),
        (("dds", "zenoh", "--allow", "/scan", "--deny", "/a b"), "CLI453"),
    ],
)
def test_invalid_bridge_arguments_are_one_error(capsys, monkeypatch, words, code):
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    assert main(["bridge", *words]) == 1
    output = capsys.readouterr()
    assert output.out == ""
    assert output.err.count("error[") == 1
    assert output.err.startswith(f"error[{code}]")


@pytest.mark.parametrize("words", [(), ("dds",), ("dds", "zenoh", "dds")])
def test_bridge_requires_two_networks(capsys, words):
    assert main(["bridge", *words]) == 2
    assert "NETWORK" in capsys.readouterr().err


def test_bridge_reports_missing_network_package(capsys, monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    assert main(["bridge", "dds", "zenoh"]) == 1
    assert "error[CLI454]: DDS (domain" in capsys.readouterr().err
