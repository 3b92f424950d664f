"""Fixtures of the reliability tests, which run after all other tests."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from linkwright.messages.distribution import ASSUMED_DISTRIBUTION_VARIABLE
from linkwright.wire import dds
from tests.domains import own_domain
from tests.reliability.running import Machine

ROS_VARIABLES = (
    "ROS_LOCALHOST_ONLY",
    "ROS_AUTOMATIC_DISCOVERY_RANGE",
    "ROS_STATIC_PEERS",
    "ROS_DISTRO",
    ASSUMED_DISTRIBUTION_VARIABLE,
    "CYCLONEDDS_URI",
    "LINKWRIGHT_DDS",
    "PYTHONDONTWRITEBYTECODE",
)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skip tests with several processes if there is no DDS wheel."""
    if not dds.is_available():
        for item in items:
            if Path(__file__).parent in item.path.parents:
                item.add_marker(pytest.mark.skip(reason="cyclonedds is not installed"))


@pytest.fixture
def machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Machine]:
    """Return the processes in a domain of this worker; all end with the test."""
    for name in ROS_VARIABLES:
        monkeypatch.delenv(name, raising=False)
    machine = Machine(tmp_path, own_domain())
    yield machine
    machine.clean_up()
