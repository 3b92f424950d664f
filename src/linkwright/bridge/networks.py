"""The networks that a bridge can connect, named ``dds``, ``dds:5`` or ``zenoh``."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from linkwright.bridge.bridged_network import ENCLAVE, BridgedNetwork
from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, phrase
from linkwright.graph import Graph
from linkwright.graph.log.logger import Logger, LogSink
from linkwright.wire import dds, zenoh
from linkwright.wire.background import BackgroundTransport
from linkwright.wire.dds.settings import read_settings as read_dds_settings
from linkwright.wire.unsupported_settings import refuse_enforced_security
from linkwright.wire.zenoh.settings import read_settings as read_zenoh_settings

_JOIN_TIMEOUT_S = 10.0


@dataclass(frozen=True)
class _NetworkKind:
    """A kind of network.

    Attributes:
        label: the name in messages.
        unavailable_reason: returns the reason why this kind is not available, or an empty string if it is.
        open_transport: creates the transport for a domain and a bridge.
        needs_hashes: see `BridgedNetwork`.
    """

    label: str
    unavailable_reason: Callable[[], Phrase]
    open_transport: Callable[[int | None, str, Logger], BackgroundTransport]
    needs_hashes: bool


def _open_dds(domain_id: int | None, bridge_id: str, logger: Logger) -> BackgroundTransport:
    settings = replace(read_dds_settings(domain_id=domain_id), enclave=f"{ENCLAVE}/{bridge_id}")
    return dds.DdsTransport(settings, logger, must_join=True)


def _open_zenoh(domain_id: int | None, _bridge_id: str, logger: Logger) -> BackgroundTransport:
    return zenoh.ZenohTransport(read_zenoh_settings(domain_id=domain_id), logger, must_join=True)


_KINDS = {
    "dds": _NetworkKind("DDS", dds.unavailable_reason, _open_dds, needs_hashes=False),
    "zenoh": _NetworkKind("Zenoh", zenoh.unavailable_reason, _open_zenoh, needs_hashes=True),
}


@dataclass(frozen=True)
class Network:
    """A network that a bridge can join.

    Attributes:
        kind: a key of the table of kinds.
        domain_id: the ROS domain.
    """

    kind: str
    domain_id: int

    @property
    def label(self) -> str:
        """The name of the network in messages."""
        return f"{_KINDS[self.kind].label} (domain {self.domain_id})"

    async def join(self, bridge_id: str, log: LogSink) -> BridgedNetwork:
        """Join the network, and return it with the bridge's nodes in it.

        Raises:
            LinkwrightError: CLI454, the package of the transport is not installed; DDS101 to DDS112, the network cannot
                be joined.
        """
        kind = _KINDS[self.kind]
        reason = kind.unavailable_reason()
        if reason:
            message = phrase("{network} cannot be joined", network=self.label)
            raise LinkwrightError(Diagnostic("CLI454", message, notes=(Note(reason),)))
        graph = Graph(on_log=log, on_shared_names=_ignore_names)
        transport = kind.open_transport(self.domain_id, bridge_id, graph.get_logger(self.kind))
        graph.attach(transport)
        network = BridgedNetwork(self.label, graph, transport, bridge_id, needs_hashes=kind.needs_hashes)
        try:
            await network.join(_JOIN_TIMEOUT_S)
        except BaseException:
            await graph.close()
            raise
        return network


def read_network(text: str) -> Network:
    """Parse a command-line argument that names a network.

    Raises:
        LinkwrightError: CLI451, the text does not name a network; DDS101, the domain is not valid; DDS121, security is
            enforced.
    """
    kind, colon, domain = text.partition(":")
    if kind not in _KINDS or (colon and not domain):
        raise LinkwrightError(
            Diagnostic(
                "CLI451",
                phrase("'{network}' is not a network that can be bridged", network=text),
                hint=phrase(
                    "write dds or zenoh; to use a domain other than ROS_DOMAIN_ID, add it after a colon, as in dds:5"
                ),
            )
        )
    refuse_enforced_security()
    settings: Any = read_dds_settings if kind == "dds" else read_zenoh_settings
    return Network(kind, settings({**os.environ, "ROS_DOMAIN_ID": domain} if colon else None).domain_id)


def _ignore_names(_names: frozenset[str]) -> None:
    """Ignore node names that exist twice, because mirrored nodes have the names of other nodes."""
