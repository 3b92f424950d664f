"""The DDS participant of this process, which creates readers and writers."""

from __future__ import annotations

import os
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.wire.dds.cyclone import CycloneError, check_call, load
from linkwright.wire.dds.open_domains import close_domain, open_domain
from linkwright.wire.dds.qos import participant_qos
from linkwright.wire.dds.settings import Settings
from linkwright.wire.dds.type_descriptions import WireTypes

NAME = "linkwright"
"""The beginning of the entity names of Linkwright's participants."""

SERVICES_NAME = "linkwright-services"
"""The entity name of our participants for services with Fast DDS, which have no nodes of their own."""


def make_entity_name() -> str:
    """Return the name of a participant of this process: kind, process id and process namespace.

    Other Linkwright processes on the same machine use the name to notice that the process has ended before its lease
    expires.
    """
    return f"{NAME}/{read_process_namespace()}/{os.getpid()}"


def read_process_namespace() -> str:
    """Return an identifier of this process's PID namespace, or an empty string.

    It distinguishes processes that have the same id in different containers.
    """
    try:
        return Path("/proc/self/ns/pid").readlink().name.strip("pid:[]")
    except OSError:
        return ""


class Participant:
    """A DDS participant.

    Args:
        settings: the domain and the configuration.

    Raises:
        LinkwrightError: DDS102 to DDS104, the participant could not be created.
    """

    def __init__(self, settings: Settings) -> None:
        self._dds = load()
        self.closed = False
        self._domain = open_domain(settings)
        try:
            with participant_qos(f"enclave={settings.enclave};".encode(), make_entity_name()) as qos:
                code = self._dds.dds_create_participant(self._domain.domain_id, qos, None)
            self.entity = check_call(code, "joining the domain")
        except CycloneError as error:
            close_domain(self._domain)
            raise _participant_error(settings, error) from error
        self.guid: bytes = self._dds.guid(self.entity)

    @property
    def types(self) -> WireTypes:
        """The type descriptions for `create_topic`."""
        return self._domain.descriptions

    def create_topic(self, name: str, described_type: object) -> int:
        """Create a topic.

        Only the name of its type is announced.

        Args:
            name: the topic's DDS name.
            described_type: the class that describes the type (`WireTypes`).

        Raises:
            CycloneError: Cyclone refuses the topic.
        """
        return self._domain.types.create_topic(self.entity, name, described_type)

    def create_reader(self, topic: int, qos: int | None) -> int:
        """Create a reader for a topic, or for one of Cyclone's builtin topics."""
        return check_call(self._dds.dds_create_reader(self.entity, topic, qos, None), "creating a reader")

    def create_writer(self, topic: int, qos: int) -> int:
        """Create a writer for a topic."""
        return check_call(self._dds.dds_create_writer(self.entity, topic, qos, None), "creating a writer")

    def delete(self, *entities: int) -> None:
        """Delete entities.

        Readers and writers must precede their topics.
        """
        for entity in entities:
            self._dds.dds_delete(entity)

    def close(self) -> None:
        """Leave the domain and delete all entities.

        The last participant in the domain also deletes the domain's sockets and threads.
        """
        self.closed = True
        self._dds.dds_delete(self.entity)
        close_domain(self._domain)


def _participant_error(settings: Settings, error: CycloneError) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic(
            code="DDS104",
            message=phrase(
                "DDS domain {domain_id} cannot be joined: {error}", domain_id=settings.domain_id, error=error
            ),
            hint=phrase("use another ROS_DOMAIN_ID, because each domain has its own ports"),
        )
    )
