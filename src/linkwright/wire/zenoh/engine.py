"""Create and withdraw the mirrors of this process's endpoints in a Zenoh session.

One thread does this in the order of the requests, and updates the tables of the remote graph. Zenoh's threads pass on
incoming traffic as bytes.
"""

from __future__ import annotations

import itertools
import threading
from collections import deque
from collections.abc import Callable
from typing import Any

import zenoh

from linkwright.graph.endpoints.base import EndpointKind
from linkwright.graph.log.logger import Logger
from linkwright.graph.names.rules import NodeIdentity
from linkwright.messages import InterfaceNotFoundError, type_hash
from linkwright.wire.engine import Engine as AnyEngine
from linkwright.wire.engine import Work, is_ending_by_error
from linkwright.wire.guarded_calls import call_guarded
from linkwright.wire.type_names import to_wire_type
from linkwright.wire.zenoh import qos_text, tokens
from linkwright.wire.zenoh.departures import ZenohDepartureMonitor
from linkwright.wire.zenoh.interests import KEY_PREFIX, Interests
from linkwright.wire.zenoh.remote import RemoteGraph
from linkwright.wire.zenoh.services import IncomingService, RemoteServer
from linkwright.wire.zenoh.session import build_config, close_session, is_client
from linkwright.wire.zenoh.session_opener import SessionOpener
from linkwright.wire.zenoh.settings import Settings
from linkwright.wire.zenoh.tokens import Token

_CLOSE_TIMEOUT_S = 1.0
"""The maximum time, in seconds, for which closing waits for the thread."""


class Engine(AnyEngine):
    """A session with its publishers, subscriptions, services and clients.

    Args:
        settings: the domain and how to join it.
        remote: the tables to fill.
        departures: decides whether remote publishers that disappeared were lost.
        work: the queue of requests; other threads append to it and call `wake`.
        logger: logs problems.
        opener: opens the session, which may take several attempts.

    Raises:
        LinkwrightError: the session cannot be opened.
    """

    library_error = zenoh.ZError

    def __init__(
        self,
        settings: Settings,
        remote: RemoteGraph,
        departures: ZenohDepartureMonitor,
        work: Work,
        logger: Logger,
        opener: SessionOpener,
    ) -> None:
        super().__init__(work, logger)
        self._settings = settings
        self._remote = remote
        self._departures = departures
        self._is_client = is_client(settings)
        self._session = opener.open(build_config(settings))
        self._session_id = str(self._session.zid())
        self._ids = itertools.count()
        self._nodes: dict[NodeIdentity, list[tuple[str, Any]]] = {}
        self._mirrors: dict[Any, Any] = {}
        self._tokens: dict[Any, Any] = {}
        self._own_gids: set[bytes] = set()
        self._token_changes: deque[tuple[bool, str]] = deque()
        self._wake_event = threading.Event()
        self._end_event = threading.Event()
        self._is_stale = False
        self._has_changed = False
        self._is_following = False
        self._thread = threading.Thread(target=self._run, name="linkwright-zenoh", daemon=True)
        self._presence_token: Any = None
        self._interests = Interests(self._session, settings.domain_id, self._on_token)

    def start(self) -> None:
        """Announce the session, subscribe to tokens, and start the thread.

        A client of a router subscribes only to the tokens that its endpoints need.
        """
        self._presence_token = self._session.liveliness().declare_token(self._make_own_token("here"))
        if not self._is_client:
            self._interests.add_all()
        self._thread.start()

    def wake(self) -> None:
        """Wake the thread that processes the queue of requests.

        Any thread may call this method.
        """
        self._wake_event.set()

    def has_neighbors(self) -> bool:
        """Return whether this session is connected to another session or a router."""
        info = self._session.info
        return bool(info.peers_zid() or info.routers_zid())

    def close(self) -> None:
        """End the session.

        The departure of our nodes is announced, unless the process ends because of an error.
        """
        self._end_event.set()
        self._wake_event.set()
        if self._thread.ident is not None and self._thread is not threading.current_thread():
            self._thread.join(_CLOSE_TIMEOUT_S)
        self._process_all_requests()
        for mirror in self._mirrors.values():
            if hasattr(mirror, "abandon"):
                mirror.abandon()
        if not is_ending_by_error():
            self._announce_departure()
        for mirror in self._mirrors.values():
            mirror.close()
        self._interests.close()
        close_session(self._session)

    def abandon(self) -> None:
        """Stop sending, and keep all Zenoh objects forever.

        In a forked process, destroying them would never finish.
        """
        import ctypes

        self._end_event.set()
        for mirror in self._mirrors.values():
            if hasattr(mirror, "abandon"):
                mirror.abandon()
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(self))

    # --- work in the engine's thread ---------------------------------------------------------------------------------

    def add_node(self, node: NodeIdentity) -> None:
        """Announce a node."""
        number = str(next(self._ids))
        token = Token(self._settings.domain_id, self._session_id, number, number, node)
        self._nodes.setdefault(node, []).append((number, self._session.liveliness().declare_token(token.key)))
        self._interests.add(tokens.node_token_pattern(self._settings.domain_id, node))

    def remove_node(self, node: NodeIdentity) -> None:
        """Withdraw a node."""
        node_tokens = self._nodes.get(node)
        if node_tokens:
            _, token = node_tokens.pop()
            token.undeclare()
            if self._interests.remove(tokens.node_token_pattern(self._settings.domain_id, node)):
                self._remote.remove_nodes(node.full_name)
            if not node_tokens:
                del self._nodes[node]

    def open_publisher(self, publisher: Any) -> None:
        """Mirror a publisher."""
        from linkwright.wire.zenoh.topics import OutgoingTopic

        try:
            token = self._create_token(publisher, EndpointKind.PUBLISHER)
            outgoing = OutgoingTopic(publisher, token, self._session, self._on_matches_changed)
        except BaseException:
            publisher.set_remote_sender(None)
            raise
        self._own_gids.add(token.gid)
        self._announce(publisher, outgoing)

    def close_publisher(self, publisher: Any) -> None:
        """Stop mirroring a publisher."""
        self.close_endpoint(publisher)

    def open_subscription(self, subscription: Any) -> None:
        """Mirror a subscription."""
        from linkwright.wire.zenoh.topics import IncomingTopic

        token = self._create_token(subscription, EndpointKind.SUBSCRIPTION)
        key = token.data_key
        if token.type_hash == tokens.NO_HASH and self._settings.has_type_hashes:  # unknown type: accept any hash
            key = tokens.data_key(token.domain_id, token.name, token.type_name, "*")
        self._announce(subscription, IncomingTopic(subscription, token, self._session, key, self._own_gids))

    def open_service(self, service: Any) -> None:
        """Mirror a service."""
        token = self._create_token(service, EndpointKind.SERVICE)
        self._announce(service, IncomingService(service, token, self._session))

    def open_client(self, client: Any) -> None:
        """Mirror a client."""
        token = self._create_token(client, EndpointKind.CLIENT)
        self._announce(client, RemoteServer(client, token, self._session, self._on_matches_changed))

    def open_presence(self, presence: Any) -> None:
        """Announce an endpoint that neither sends nor receives, by declaring its token."""
        token = self._create_token(presence, presence.kind)
        presence.gid = token.gid
        self._tokens[presence] = self._session.liveliness().declare_token(token.key)

    def close_endpoint(self, endpoint: Any) -> None:
        """Stop mirroring an endpoint.

        The token is withdrawn first, so that other processes no longer rely on the endpoint.
        """
        token = self._tokens.pop(endpoint, None)
        if token is not None:
            token.undeclare()
        mirror = self._mirrors.pop(endpoint, None)
        if mirror is not None:
            mirror.close()
            self._own_gids.discard(mirror.token.gid)
            peer_kind = _PEER_KINDS.get(mirror.token.kind)
            if peer_kind is not None and self._interests.remove(tokens.peer_token_pattern(mirror.token, peer_kind)):
                self._remote.remove_endpoints(peer_kind, mirror.token.data_key)

    def _announce(self, endpoint: Any, mirror: Any) -> None:
        """Announce an endpoint whose mirror has been created, and subscribe to matching tokens."""
        self._mirrors[endpoint] = mirror
        if endpoint.is_listed:
            self._tokens[endpoint] = self._session.liveliness().declare_token(mirror.token.key)
        peer_kind = _PEER_KINDS.get(mirror.token.kind)
        if peer_kind is not None:
            self._interests.add(tokens.peer_token_pattern(mirror.token, peer_kind))
        self._update_match_count(mirror)

    def _create_token(self, endpoint: Any, kind: EndpointKind) -> Token:
        node_tokens = self._nodes.get(endpoint.node.identity)
        if not node_tokens:
            self.add_node(endpoint.node.identity)
            node_tokens = self._nodes[endpoint.node.identity]
        node_id = node_tokens[-1][0]
        return Token(
            self._settings.domain_id,
            self._session_id,
            node_id,
            str(next(self._ids)),
            endpoint.node.identity,
            kind,
            endpoint.name,
            to_wire_type(endpoint.type_name),
            self._get_type_hash(endpoint, kind),
            qos_text.write(endpoint.qos_profile),
        )

    def _get_type_hash(self, endpoint: Any, kind: EndpointKind) -> str:
        if not self._settings.has_type_hashes:
            return tokens.NO_HASH
        if endpoint.type_hash:
            return str(endpoint.type_hash)
        try:
            return type_hash(endpoint.type_name)
        except InterfaceNotFoundError:
            if kind in (EndpointKind.SUBSCRIPTION, EndpointKind.CLIENT) and endpoint.raw:  # raw endpoints need no hash
                return tokens.NO_HASH
            raise

    def start_discovery(self, seconds: float, on_answered: Callable[[], None]) -> None:
        """Start discovering the whole graph.

        Args:
            seconds: the maximum time that processes have to announce themselves.
            on_answered: called from any thread when all have answered or the time is over.
        """
        self._interests.request_all(seconds, on_answered)
        self._interests.add_all()

    def process_tokens(self) -> None:
        """Process the tokens that have been received since the last call."""
        while self._token_changes:
            appeared, key = self._token_changes.popleft()
            self._has_changed = self._record_token(appeared=appeared, key=key) or self._has_changed
        must_follow = self._departures.is_watched and not self._interests.subscribes_to_all
        if must_follow and (self._has_changed or not self._is_following):
            live_sessions = self._remote.find_sessions() | self._departures.live_sessions
            self._interests.follow(self._remote.find_sessions(EndpointKind.PUBLISHER), live_sessions)
        self._is_following = must_follow

    @property
    def is_current_thread(self) -> bool:
        """Whether the calling thread is the engine's thread."""
        return threading.current_thread() is self._thread

    # --- callbacks from threads of Zenoh -----------------------------------------------------------------------------

    def _on_token(self, sample: zenoh.Sample) -> None:
        self._token_changes.append((sample.kind == zenoh.SampleKind.PUT, str(sample.key_expr)))
        self._wake_event.set()

    def _on_matches_changed(self) -> None:
        self._is_stale = True
        self._wake_event.set()

    # --- the thread --------------------------------------------------------------------------------------------------

    def _run(self) -> None:
        self._look_for_router()
        while not self._end_event.is_set():
            self._wake_event.clear()
            self._process_some_requests()
            call_guarded(self._update_mirrors, self._report)
            timeout = 0.0 if self._work else call_guarded(self._departures.report_lost_publishers, self._report)
            self._wake_event.wait(timeout)

    def _update_mirrors(self) -> None:
        self.process_tokens()
        has_changed, self._has_changed = self._has_changed, False
        if has_changed or self._is_stale:
            self._is_stale = False
            for mirror in tuple(self._mirrors.values()):
                self._update_match_count(mirror)
        if has_changed:
            self._remote.announce()

    def _record_token(self, *, appeared: bool, key: str) -> bool:
        """Record that a token appeared or disappeared.

        Return whether that changes the remote graph.
        """
        if key.startswith(KEY_PREFIX):
            self._record_session(appeared=appeared, key=key)
            return False
        token = tokens.read(key)
        if token is None or token.session == self._session_id:
            return False
        if appeared:
            return not (self._is_client and self._remote.was_just_removed(key)) and self._remote.add(key, token)
        if self._remote.remove(key) is None:
            return False
        self._departures.on_token_removed(key, token)
        return True

    def _record_session(self, *, appeared: bool, key: str) -> None:
        """Record that a token of a Linkwright session appeared or disappeared."""
        _, _, session, state = key.split("/")
        if state == "here" and appeared:
            self._departures.on_session_started(session)
        elif state == "here":
            self._departures.on_session_ended(session)
            self._is_following = False  # makes `process_tokens` end the subscription to that session
        elif appeared:
            self._departures.on_session_leaving(session)

    def _update_match_count(self, mirror: Any) -> None:
        peer_kind = _PEER_KINDS.get(mirror.token.kind)
        if peer_kind is not None:
            mirror.update_match_count(self._remote.count(peer_kind, mirror.token.data_key))

    def _look_for_router(self) -> None:
        """Wait for a router if ZENOH_ROUTER_CHECK_ATTEMPTS is set, then continue without one."""
        attempts = self._settings.attempts
        for attempt in itertools.count():
            if self._end_event.is_set() or (attempts is not None and attempt >= attempts):
                break
            if self._session.info.routers_zid():
                return
            self._end_event.wait(1.0)
        if attempts and not self._end_event.is_set() and not self._session.info.routers_zid():
            self._logger.warning(
                "There is no Zenoh router: nodes of rmw_zenoh_cpp are not found. Start one with "
                "'linkwright run rmw_zenoh_cpp rmw_zenohd', or 'ros2 run rmw_zenoh_cpp rmw_zenohd'"
            )

    def _announce_departure(self) -> None:
        """Announce the departure of this session, then withdraw its endpoints and its nodes."""
        departure_token = self._session.liveliness().declare_token(self._make_own_token("left"))
        for token in self._tokens.values():
            token.undeclare()
        for node_tokens in self._nodes.values():
            for _, token in node_tokens:
                token.undeclare()
        self._presence_token.undeclare()
        departure_token.undeclare()

    def _make_own_token(self, state: str) -> str:
        return f"{KEY_PREFIX}/{self._settings.domain_id}/{self._session_id}/{state}"


_PEER_KINDS = {
    EndpointKind.PUBLISHER: EndpointKind.SUBSCRIPTION,
    EndpointKind.SUBSCRIPTION: EndpointKind.PUBLISHER,
    EndpointKind.CLIENT: EndpointKind.SERVICE,
}
"""The kind of remote endpoints that are counted for each kind of endpoint."""
