"""Data keys, and liveliness tokens that announce nodes and endpoints, as in rmw_zenoh_cpp.

The data of a topic or service has the key ``<domain>/<name>/<type>/<hash>``. A token is
``@ros2_lv/<domain>/<session>/<node's id>/<id>/<kind>/<enclave>/<namespace>/<node>``. For an endpoint,
``<name>/<type>/<hash>/<QoS>`` follows. A slash within a chunk becomes ``%``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.profile import QoSProfile
from linkwright.wire.type_names import to_ros_type
from linkwright.wire.zenoh import qos_text

if TYPE_CHECKING:
    from collections.abc import Iterable

ROOT = "@ros2_lv"
NO_HASH = "TypeHashNotSupported"
"""The placeholder for a hash in Humble."""

KINDS = {
    "MP": EndpointKind.PUBLISHER,
    "MS": EndpointKind.SUBSCRIPTION,
    "SS": EndpointKind.SERVICE,
    "SC": EndpointKind.CLIENT,
}
_MARKS = {kind: mark for mark, kind in KINDS.items()}
_NODE_MARK = "NN"
_NODE_CHUNKS = 9
_ENDPOINT_CHUNKS = 13
_SLASH = "%"


@dataclass(frozen=True)
class Token:
    """The token of a node or of an endpoint.

    Attributes:
        domain_id: the ROS domain.
        session: the id of the Zenoh session.
        node_id: the id of the node in the session.
        entity_id: the id of the node or endpoint; for a node, equal to `node_id`.
        node: the node, or the endpoint's node.
        kind: the kind of the endpoint; None for a node.
        name: the absolute ROS name of the topic or service.
        type_name: the name of the type on the wire, such as ``std_msgs::msg::dds_::String_``.
        type_hash: ``RIHS01_...``, or `NO_HASH`.
        qos: the QoS as encoded on the wire, see `qos_text`.
    """

    domain_id: int
    session: str
    node_id: str
    entity_id: str
    node: NodeIdentity
    kind: EndpointKind | None = None
    name: str = ""
    type_name: str = ""
    type_hash: str = ""
    qos: str = ""

    @cached_property
    def key(self) -> str:
        """The token's key expression."""
        session_chunks: Iterable[str] = (ROOT, str(self.domain_id), self.session, self.node_id, self.entity_id)
        mark = _NODE_MARK if self.kind is None else _MARKS[self.kind]
        node_chunks = (_to_chunk(self.node.enclave), _to_chunk(self.node.namespace), self.node.name)
        if self.kind is None:
            return "/".join((*session_chunks, mark, *node_chunks))
        endpoint_chunks = (_to_chunk(self.name), _to_chunk(self.type_name), _to_chunk(self.type_hash), self.qos)
        return "/".join((*session_chunks, mark, *node_chunks, *endpoint_chunks))

    @cached_property
    def data_key(self) -> str:
        """The data key of the endpoint's topic or service."""
        return data_key(self.domain_id, self.name, self.type_name, self.type_hash)

    @cached_property
    def gid(self) -> bytes:
        """The endpoint's gid: the 128-bit XXH3 hash of the token, least significant byte first."""
        from xxhash import xxh3_128_digest

        return bytes(reversed(xxh3_128_digest(self.key.encode())))

    @property
    def node_key(self) -> tuple[str, str]:
        """The id of the session and the id of the node in it.

        A node and its endpoints share them.
        """
        return self.session, self.node_id

    def endpoint_info(self) -> EndpointInfo | None:
        """Return the endpoint's description in ROS terms, or None for nodes and non-ROS endpoints."""
        type_name = to_ros_type(self.type_name)
        if self.kind is None or type_name is None:
            return None
        type_hash = "" if self.type_hash == NO_HASH else self.type_hash
        return EndpointInfo(self.kind, self.node, self.name, type_name, self._parse_profile, self.gid, type_hash)

    @cached_property
    def _parse_profile(self) -> QoSProfile:
        return qos_text.read(self.qos)


def data_key(domain_id: int, name: str, type_name: str, type_hash: str) -> str:
    """Return the key of the data of a topic or service."""
    return f"{domain_id}/{name.strip('/')}/{type_name}/{type_hash}"


def node_token_pattern(domain_id: int, node: NodeIdentity) -> str:
    """Return the key expression that matches the tokens of all nodes with a full name."""
    return f"{ROOT}/{domain_id}/*/*/*/{_NODE_MARK}/*/{_to_chunk(node.namespace)}/{node.name}"


def peer_token_pattern(token: Token, kind: EndpointKind) -> str:
    """Return the key expression for the tokens of matching endpoints of the given kind.

    Matching endpoints have the same data key.
    """
    topic_chunks = (_to_chunk(token.name), _to_chunk(token.type_name), _to_chunk(token.type_hash))
    return "/".join((ROOT, str(token.domain_id), "*/*/*", _MARKS[kind], "*/*/*", *topic_chunks, "**"))


def read(key: str) -> Token | None:
    """Parse a key expression into a token, or return None if it is not the key of a ROS token."""
    chunks = key.split("/")
    if len(chunks) < _NODE_CHUNKS or chunks[0] != ROOT or not chunks[1].isdecimal():
        return None
    _, domain, session, node_id, entity_id, mark, enclave, namespace, name = chunks[:_NODE_CHUNKS]
    node = NodeIdentity(name, _from_chunk(namespace), _from_chunk(enclave))
    if mark == _NODE_MARK:
        return Token(int(domain), session, node_id, entity_id, node)
    if mark not in KINDS or len(chunks) < _ENDPOINT_CHUNKS:
        return None
    topic, type_name, type_hash, qos = chunks[_NODE_CHUNKS:_ENDPOINT_CHUNKS]  # newer distributions may append chunks
    if not _is_profile(qos):
        return None
    return Token(
        int(domain),
        session,
        node_id,
        entity_id,
        node,
        KINDS[mark],
        _from_chunk(topic),
        _from_chunk(type_name),
        type_hash,
        qos,
    )


@lru_cache(maxsize=1024)
def _is_profile(text: str) -> bool:
    """Return whether a chunk is a QoS profile.

    The result is cached, because a graph has many endpoints but few different profiles.
    """
    try:
        qos_text.read(text)
    except ValueError:
        return False
    return True


def _to_chunk(text: str) -> str:
    return text.replace("/", _SLASH) or _SLASH


def _from_chunk(chunk: str) -> str:
    return chunk.replace(_SLASH, "/")
