"""This process as a participant of a DDS domain: made, and asked for readers and writers."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from threading import Lock

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.graph.dds.cyclone import CycloneError, checked, load
from linkwright.graph.dds.settings import PARTICIPANTS, Settings
from linkwright.graph.dds.wire_qos import participant_qos

NAME = "linkwright"
"""How our participants' entity names begin."""

_opened: dict[int, tuple[int, int]] = {}
"""The domains of this process: Cyclone's handle and how many participants are on it."""

_opened_lock = Lock()


def entity_name() -> str:
    """The name of a participant of this process: what it is, its process and the process namespace that counts in.

    Others of ours see by it, on the same machine, that the process is gone before its lease has run out.
    """
    return f"{NAME}/{process_namespace()}/{os.getpid()}"


def process_namespace() -> str:
    """What tells processes apart that have the same number in different containers; empty where there is no telling."""
    try:
        return Path("/proc/self/ns/pid").readlink().name.strip("pid:[]")
    except OSError:
        return ""


class Participant:
    """A participant.

    Args:
        settings: the domain and the configuration.

    Raises:
        LinkwrightError: DDS102 to DDS104, it could not be made.
    """

    def __init__(self, settings: Settings) -> None:
        self._dds = load()
        self._domain_id = settings.domain_id
        self.closed = False
        domain = _open_domain(settings)
        try:
            with participant_qos(b"enclave=/;", entity_name()) as qos:
                code = self._dds.dds_create_participant(domain, qos, None)
            self.entity = checked(code, "joining the domain")
        except CycloneError as error:
            _close_domain(settings.domain_id)
            raise _no_participant(settings, error) from error
        self.guid: bytes = self._dds.guid(self.entity)

    def create_topic(self, name: str, described_type: object) -> int:
        """A topic of a type.

        Args:
            name: its DDS name.
            described_type: the class that describes it (`WireTypes`).

        Raises:
            CycloneError: Cyclone refuses it.
        """
        return checked(self._dds.create_topic(self.entity, name, described_type, None, None), f"topic '{name}'")

    def create_reader(self, topic: int, qos: int | None) -> int:
        """A reader of a topic or of one of Cyclone's own."""
        return checked(self._dds.dds_create_reader(self.entity, topic, qos, None), "making a reader")

    def create_writer(self, topic: int, qos: int) -> int:
        """A writer of a topic."""
        return checked(self._dds.dds_create_writer(self.entity, topic, qos, None), "making a writer")

    def delete(self, *entities: int) -> None:
        """Delete entities, readers and writers before their topics."""
        for entity in entities:
            self._dds.dds_delete(entity)

    def close(self) -> None:
        """Leave the domain; everything that was made goes with it, and with the last its sockets and threads."""
        self.closed = True
        self._dds.dds_delete(self.entity)
        _close_domain(self._domain_id)


def _open_domain(settings: Settings) -> int:
    """The number of the domain, opened with the settings unless it is open.

    Raises:
        LinkwrightError: DDS102 or DDS103, Cyclone cannot open it.
    """
    with _opened_lock:
        handle, users = _opened.get(settings.domain_id, (0, 0))
        if not users:
            handle = _create_domain(settings)
        _opened[settings.domain_id] = (handle, users + 1)
    return settings.domain_id


def _close_domain(domain_id: int) -> None:
    with _opened_lock:
        handle, users = _opened.pop(domain_id)
        if users > 1:
            _opened[domain_id] = (handle, users - 1)
        else:
            load().dds_delete(handle)


def _create_domain(settings: Settings) -> int:
    """The domain with the first configuration that Cyclone takes; it says by itself what it does not like in one.

    Raises:
        LinkwrightError: DDS102 or DDS103, it takes none.
    """
    code = _first_taken(settings.domain_id, settings.configurations)
    if code >= 0:
        return code
    if settings.user_configuration:
        without = _first_taken(settings.domain_id, settings.own_configurations)
        if without >= 0:
            load().dds_delete(without)
            raise LinkwrightError(
                Diagnostic(
                    code="DDS102",
                    message=f"Cyclone DDS refuses the configuration in CYCLONEDDS_URI '{settings.user_configuration}'",
                    hint="it is XML text or the URL of an XML file such as file:///home/me/cyclonedds.xml; "
                    "Cyclone's own words about it are above",
                )
            )
    raise LinkwrightError(
        Diagnostic(
            code="DDS103",
            message=f"Cyclone DDS cannot open domain {settings.domain_id}; its own words about it are above",
            hint=f"at most {PARTICIPANTS} processes may be on it, no other program may hold its ports (7400 and what "
            "follows, 250 a domain), and a network interface must be up; another ROS_DOMAIN_ID has other ports, "
            "CYCLONEDDS_URI can name an interface",
        )
    )


def _first_taken(domain_id: int, configurations: Sequence[str]) -> int:
    code = 0
    for configuration in configurations:
        code = load().dds_create_domain(domain_id, configuration.encode())
        if code >= 0:
            break
    return code


def _no_participant(settings: Settings, error: CycloneError) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic(
            code="DDS104",
            message=f"DDS domain {settings.domain_id} cannot be joined: {error}",
            hint="another ROS_DOMAIN_ID has ports of its own",
        )
    )
