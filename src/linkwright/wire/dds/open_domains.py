"""The open DDS domains of this process.

Several graphs may share a domain.
"""

from __future__ import annotations

from collections.abc import Sequence
from socket import socket
from threading import Lock

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.wire.dds.confinement import confine_announcements
from linkwright.wire.dds.cyclone import LOG_ERRORS, load
from linkwright.wire.dds.settings import Settings, find_own_addresses, max_participants
from linkwright.wire.dds.topic_types import TopicTypes
from linkwright.wire.dds.type_descriptions import WireTypes


class OpenDomain:
    """A domain with the entities that its participants share.

    Attributes:
        domain_id: the domain id.
        handle: Cyclone's handle.
        users: the number of participants in the domain.
        descriptions: the descriptions of types.
        types: Cyclone's types of the topics.
        confinement: the socket that keeps announcements inside the machine; None if they may leave it.
    """

    def __init__(self, domain_id: int, handle: int, confinement: socket | None = None) -> None:
        self.domain_id = domain_id
        self.handle = handle
        self.confinement = confinement
        self.users = 0
        self.descriptions = WireTypes()
        self.types = TopicTypes()


_opened: dict[int, OpenDomain] = {}

_lock = Lock()


def open_domain(settings: Settings) -> OpenDomain:
    """Return a domain for one more participant, opening it with the settings if necessary.

    Raises:
        LinkwrightError: DDS102 or DDS103, Cyclone cannot open the domain.
    """
    with _lock:
        domain = _opened.get(settings.domain_id)
        if domain is None:
            domain = _opened[settings.domain_id] = _create_domain(settings)
        domain.users += 1
        return domain


def close_domain(domain: OpenDomain) -> None:
    """Remove a participant from a domain.

    The last one closes the domain's sockets and threads.
    """
    with _lock:
        domain.users -= 1
        if not domain.users:
            del _opened[domain.domain_id]
            if load().dds_delete(domain.handle) >= 0:
                domain.types.free()
            if domain.confinement is not None:
                domain.confinement.close()


def _create_domain(settings: Settings) -> OpenDomain:
    """Open a domain with the first configuration that Cyclone accepts.

    Cyclone prints the reasons for rejecting the others.

    Raises:
        LinkwrightError: DDS102 or DDS103, Cyclone accepts none of the configurations.
    """
    configurations, confinement = settings.configurations, None
    if settings.loopback_configurations:
        try:
            confinement = confine_announcements(find_own_addresses())
        except OSError:
            configurations = settings.loopback_configurations
    code = _create_with_first_accepted(settings.domain_id, configurations)
    if code >= 0:
        if not settings.user_configuration:
            # Log errors only. Each malformed or foreign packet causes a warning, so any process could flood the log.
            load().dds_set_log_mask(LOG_ERRORS)
        return OpenDomain(settings.domain_id, code, confinement)
    if confinement is not None:
        confinement.close()
    if settings.user_configuration:
        own_code = _create_with_first_accepted(settings.domain_id, settings.own_configurations)
        if own_code >= 0:
            load().dds_delete(own_code)
            raise LinkwrightError(
                Diagnostic(
                    code="DDS102",
                    message=phrase(
                        "Cyclone DDS refuses the configuration in CYCLONEDDS_URI '{user_configuration}'",
                        user_configuration=settings.user_configuration,
                    ),
                    hint=phrase(
                        "write XML text or the URL of an XML file, such as file:///home/me/cyclonedds.xml; "
                        "Cyclone's messages above give the reason"
                    ),
                )
            )
    raise LinkwrightError(
        Diagnostic(
            code="DDS103",
            message=phrase(
                "Cyclone DDS cannot open domain {domain_id}; its messages above give the reason",
                domain_id=settings.domain_id,
            ),
            hint=phrase(
                "check that at most {maximum} processes are in the domain, that its ports (from 7400, 250 per "
                "domain) are free, and that a network interface is up; otherwise use another ROS_DOMAIN_ID, or "
                "name an interface in CYCLONEDDS_URI",
                maximum=max_participants(settings.domain_id),
            ),
        )
    )


def _create_with_first_accepted(domain_id: int, configurations: Sequence[str]) -> int:
    code = 0
    for configuration in configurations:
        code = load().dds_create_domain(domain_id, configuration.encode())
        if code >= 0:
            break
    return code
