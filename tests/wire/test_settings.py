"""The discovery settings that environment variables give."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.wire.dds.discovery_info import GID_SIZE, OLD_GID_SIZE
from linkwright.wire.dds.settings import Range, find_own_addresses, read_settings


def configuration_elements(settings):
    """Return the preferred configuration: path -> texts and attributes."""
    settings_by_path = {}

    def walk(element, path):
        settings_by_path.setdefault(path, []).append(element.text or element.attrib)
        for child in element:
            walk(child, f"{path}/{child.tag}" if path else child.tag)

    walk(ET.fromstring(settings.configurations[0].split(",")[0]).find("Domain"), "")
    return settings_by_path


def test_default_range_is_own_machine():
    settings = read_settings({})
    assert (settings.domain_id, settings.range) == (0, Range.MACHINE)
    document = configuration_elements(settings)
    assert document["General/MulticastTimeToLive"] == ["0"]
    assert document["General/MulticastRecvNetworkInterfaceAddresses"] == ["127.0.0.1"]
    peers = [peer["address"] for peer in document["Discovery/Peers/Peer"]]
    assert peers == ["127.0.0.1", *find_own_addresses()[:3]]


def test_machine_without_network_uses_loopback(monkeypatch):
    monkeypatch.setattr("linkwright.wire.dds.settings.find_own_addresses", list)
    settings = configuration_elements(read_settings({}))
    assert settings["General/Interfaces/NetworkInterface"] == [{"address": "127.0.0.1", "multicast": "true"}]


@pytest.mark.parametrize(
    ("variables", "expected"),
    [
        ({"ROS_LOCALHOST_ONLY": "1"}, Range.LOCALHOST),
        ({"ROS_LOCALHOST_ONLY": "0"}, Range.SUBNET),
        ({"ROS_LOCALHOST_ONLY": "1", "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, Range.LOCALHOST),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, Range.SUBNET),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, Range.LOCALHOST),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}, Range.OFF),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"}, Range.SYSTEM_DEFAULT),
        ({"CYCLONEDDS_URI": "file:///a.xml"}, Range.SUBNET),
        ({"ROS_STATIC_PEERS": "192.0.2.7"}, Range.SUBNET),
    ],
)
def test_ros_variables_set_discovery_range(variables, expected):
    assert read_settings(variables).range is expected


def peer_settings(address: str) -> dict[str, str]:
    """Return the settings of an address that is asked without a time limit."""
    return {"address": address, "PruneDelay": "inf"}


OWN_PEER = peer_settings("127.0.0.1")


def test_subnet_settings_match_rmw_cyclonedds_and_keep_own_machine():
    """Subnet settings include the own machine.

    A node of Fast DDS that is limited to this machine ignores announcements of other machines.
    """
    settings = configuration_elements(
        read_settings({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "ROS_STATIC_PEERS": "192.0.2.7;host"})
    )
    assert settings == {
        "": [{}],
        "Discovery": [{}],
        "Discovery/ParticipantIndex": ["auto"],
        "Discovery/MaxAutoParticipantIndex": ["32"],
        "Discovery/SPDPInterval": ["3 s"],
        "Discovery/Peers": [{}],
        "Discovery/Peers/Peer": [OWN_PEER, peer_settings("192.0.2.7"), peer_settings("host")],
    }


def test_localhost_range_equals_own_machine():
    """The range of localhost equals the own machine.

    Humble's rmw_cyclonedds then uses the loopback interface, and Jazzy's uses the one that Cyclone chooses.
    """
    machine = read_settings({}).configurations
    assert read_settings({"ROS_LOCALHOST_ONLY": "1"}).configurations == machine
    assert read_settings({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}).configurations == machine


def test_localhost_with_peers_matches_rmw_cyclonedds():
    settings = configuration_elements(read_settings({"ROS_LOCALHOST_ONLY": "1", "ROS_STATIC_PEERS": "192.0.2.7"}))
    assert settings["General/AllowMulticast"] == ["false"]
    assert settings["Discovery/Peers/Peer"] == [OWN_PEER, peer_settings("192.0.2.7")]


def test_user_configuration_is_applied_last():
    settings = read_settings({"CYCLONEDDS_URI": "file:///a.xml"})
    assert all(configuration.endswith(",file:///a.xml") for configuration in settings.configurations)
    system = read_settings({"CYCLONEDDS_URI": "file:///a.xml", "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"})
    assert system.configurations == ("file:///a.xml",)


def test_discovery_off_uses_unique_tag():
    settings = configuration_elements(read_settings({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}))
    assert settings["Discovery/ParticipantIndex"] == ["none"]
    assert settings["Discovery/Tag"][0].startswith("ros_discovery_off_")


def test_ignored_static_peers_are_reported():
    settings = read_settings({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF", "ROS_STATIC_PEERS": "192.0.2.7"})
    assert settings.warnings == ("1 static peers were specified, but discovery is OFF: they are ignored",)


@pytest.mark.parametrize(
    ("distribution", "size"),
    [("", OLD_GID_SIZE), ("humble", OLD_GID_SIZE), ("Foxy", OLD_GID_SIZE), ("iron", GID_SIZE), ("jazzy", GID_SIZE)],
)
def test_gid_size_matches_distribution(distribution, size):
    assert read_settings({"ROS_DISTRO": distribution}).gid_size == size


@pytest.mark.parametrize(("text", "expected"), [("", 0), ("0", 0), (" 7 ", 7), ("232", 232)])
def test_domain_id_is_read(text, expected):
    assert read_settings({"ROS_DOMAIN_ID": text}).domain_id == expected
    assert read_settings({"ROS_DOMAIN_ID": "50"}, domain_id=3).domain_id == 3


@pytest.mark.parametrize("text", ["233", "-1", "x", "1.0"])
def test_invalid_domain_id_is_rejected(text):
    with pytest.raises(LinkwrightError) as caught:
        read_settings({"ROS_DOMAIN_ID": text})
    assert caught.value.diagnostics[0].code == "DDS101"
