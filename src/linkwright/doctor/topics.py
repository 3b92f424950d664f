"""Problems of nodes, topics and services.

The problems concern names, types, quality of service, and managed nodes that are not active.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, nearest, phrase
from linkwright.doctor.record import TWIST, TWIST_STAMPED, Observation, listed, node_of, nodes_of
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.qos.compatibility import incompatible_policies
from linkwright.graph.qos.profile import QoSPolicyKind

_COMMAND = "cmd_vel"
"""The last part of the names of topics for velocity commands; other topics may well lack a subscriber."""
_VELOCITIES = (TWIST, TWIST_STAMPED)
_EVERYWHERE = frozenset({"/parameter_events", "/rosout", "/clock"})
"""Topics that nodes subscribe to whether or not a node publishes them."""
_MOST_DIFFERENT = 3
"""The greatest difference in length between a name and its misspelling."""


def examine_topics(seen: Observation) -> Iterator[Diagnostic]:
    """Yield findings on nodes, topics and services."""
    yield from _same_names(seen)
    yield from _types(seen)
    yield from _qos(seen)
    yield from _unpublished(seen)
    yield from _unheard_commands(seen)
    yield from _two_drivers(seen)
    yield from _unserved(seen)


def _same_names(seen: Observation) -> Iterator[Diagnostic]:
    for name, count in sorted(Counter(seen.nodes).items()):
        if count > 1:
            yield Diagnostic(
                "DOC101",
                phrase("{count} nodes have the name '{name}'", count=count, name=name),
                severity=Severity.WARNING,
                notes=(
                    Note(phrase("their parameter services answer in turn, and commands reach one of them by chance")),
                ),
                hint=phrase("stop the node that was left running, or rename one: --ros-args -r __node:=OTHER"),
            )


def _types(seen: Observation) -> Iterator[Diagnostic]:
    by_topic: dict[str, dict[str, list[EndpointInfo]]] = {}
    for endpoint in (*seen.of_kind(EndpointKind.PUBLISHER), *seen.of_kind(EndpointKind.SUBSCRIPTION)):
        by_topic.setdefault(endpoint.name, {}).setdefault(endpoint.type_name, []).append(endpoint)
    for topic, all_types in sorted(by_topic.items()):
        types = _without_universal_subscribers(all_types)
        if len(types) < 2:
            continue
        notes = tuple(note for name, endpoints in sorted(types.items()) for note in _who(endpoints, name))
        if set(types) == {TWIST, TWIST_STAMPED}:
            yield Diagnostic(
                "DOC202",
                phrase(
                    "topic '{topic}' carries Twist for some nodes and TwistStamped for others, so nothing moves",
                    topic=topic,
                ),
                notes=notes,
                hint=phrase(
                    "make both sides the same: many controllers have a parameter for it (use_stamped_vel, "
                    "enable_stamped_cmd_vel, stamped), teleop_twist_keyboard has stamped:=true"
                ),
            )
        else:
            yield Diagnostic(
                "DOC201",
                phrase(
                    "topic '{topic}' has {count} types; nodes that use different types do not receive each "
                    "other's messages",
                    topic=topic,
                    count=len(types),
                ),
                notes=notes,
                hint=phrase("remap the topic of one of them: --ros-args -r OLD:=NEW"),
            )


def _without_universal_subscribers(types: dict[str, list[EndpointInfo]]) -> dict[str, list[EndpointInfo]]:
    """Return a topic's endpoints by type, without the subscriptions of nodes that subscribe to all published types.

    Only a node that subscribes to more than one type counts as such a node. Its publishers remain. The result is empty
    if no other node subscribes.
    """
    every = [endpoint for endpoints in types.values() for endpoint in endpoints]
    published = {endpoint.type_name for endpoint in every if endpoint.kind is EndpointKind.PUBLISHER}
    heard: dict[str, set[str]] = {}
    for endpoint in every:
        if endpoint.kind is EndpointKind.SUBSCRIPTION:
            heard.setdefault(node_of(endpoint), set()).add(endpoint.type_name)
    takers = {node for node, names in heard.items() if len(names) > 1 and names >= published}
    if takers and takers == set(heard):
        return {}
    kept: dict[str, list[EndpointInfo]] = {}
    for endpoint in every:
        if endpoint.kind is EndpointKind.PUBLISHER or node_of(endpoint) not in takers:
            kept.setdefault(endpoint.type_name, []).append(endpoint)
    return kept


def _who(endpoints: list[EndpointInfo], type_name: str) -> Iterator[Note]:
    publishers = nodes_of(endpoint for endpoint in endpoints if endpoint.kind is EndpointKind.PUBLISHER)
    if publishers:
        yield Note(
            phrase("{type_name} is published by {publishers}", type_name=type_name, publishers=listed(publishers))
        )
    subscribers = nodes_of(endpoint for endpoint in endpoints if endpoint.kind is EndpointKind.SUBSCRIPTION)
    if subscribers:
        yield Note(
            phrase(
                "{type_name} is subscribed to by {subscribers}", type_name=type_name, subscribers=listed(subscribers)
            )
        )


def _qos(seen: Observation) -> Iterator[Diagnostic]:
    if seen.over_zenoh:
        return
    publishers = seen.of_kind(EndpointKind.PUBLISHER)
    reported = set()
    for subscription in seen.of_kind(EndpointKind.SUBSCRIPTION):
        for publisher in publishers:
            if publisher.name != subscription.name or publisher.type_name != subscription.type_name:
                continue
            policies = tuple(incompatible_policies(publisher.qos, subscription.qos))
            key = (publisher.name, node_of(publisher), node_of(subscription), policies)
            if policies and key not in reported:
                reported.add(key)
                yield _mismatch(publisher, subscription, policies)


def _mismatch(publisher: EndpointInfo, subscription: EndpointInfo, policies: tuple[QoSPolicyKind, ...]) -> Diagnostic:
    sender, receiver = node_of(publisher), node_of(subscription)
    notes = []
    for policy in policies:
        name = policy.name.lower()
        offered, requested = _terms(publisher, policy), _terms(subscription, policy)
        notes.append(
            Note(
                phrase(
                    "{name}: '{sender}' offers {offered}, '{receiver}' requests {requested}",
                    name=name,
                    sender=sender,
                    offered=offered,
                    receiver=receiver,
                    requested=requested,
                )
            )
        )
    return Diagnostic(
        "DOC203",
        phrase(
            "'{receiver}' gets nothing from '{sender}' on topic '{name}': their quality of service differs",
            receiver=receiver,
            sender=sender,
            name=publisher.name,
        ),
        notes=tuple(notes),
        hint=_remedy(policies[0]),
    )


def _remedy(policy: QoSPolicyKind) -> Phrase:
    if policy is QoSPolicyKind.RELIABILITY:
        return phrase(
            "make the publisher reliable, or the subscription best effort (in RViz: the display's Reliability Policy)"
        )
    if policy is QoSPolicyKind.DURABILITY:
        return phrase(
            "make the publisher transient local, or the subscription volatile (in RViz: the display's "
            "Durability Policy)"
        )
    return phrase("let the publisher offer more, or the subscription request less")


def _terms(endpoint: EndpointInfo, policy: QoSPolicyKind) -> str:
    """Return the value of a QoS policy of an endpoint as text, such as ``RELIABLE``."""
    value = getattr(endpoint.qos, policy.name.lower())
    if policy is QoSPolicyKind.LIVELINESS:
        return f"{value.name} ({endpoint.qos.liveliness_lease_duration})"
    return str(getattr(value, "name", value))


def _misnamed(seen: Observation) -> Iterator[tuple[str, str, list[EndpointInfo], str]]:
    """Yield topics without a publisher whose subscribers probably mean another, published topic.

    Yields:
        The topic, its type, its subscriptions, and the published topic.
    """
    published: dict[str, set[str]] = {}
    senders: dict[str, set[str]] = {}
    for endpoint in seen.of_kind(EndpointKind.PUBLISHER):
        published.setdefault(endpoint.name, set()).add(endpoint.type_name)
        senders.setdefault(endpoint.name, set()).add(node_of(endpoint))
    wanting: dict[tuple[str, str], list[EndpointInfo]] = {}
    for endpoint in seen.of_kind(EndpointKind.SUBSCRIPTION):
        if endpoint.name not in published and endpoint.name not in _EVERYWHERE and "/_action/" not in endpoint.name:
            wanting.setdefault((endpoint.name, endpoint.type_name), []).append(endpoint)
    heard = {endpoint.name for endpoint in seen.of_kind(EndpointKind.SUBSCRIPTION)}
    for (topic, type_name), endpoints in sorted(wanting.items()):
        # A published topic that already has a subscriber is probably meant for it, and no node means to subscribe to
        # itself.
        takers = set(nodes_of(endpoints))
        unheard = [
            name
            for name, types in published.items()
            if type_name in types and name not in heard and not takers & senders[name]
        ]
        like = _alike(topic, unheard)
        if like is not None:
            yield topic, type_name, endpoints, like


def _unpublished(seen: Observation) -> Iterator[Diagnostic]:
    for topic, type_name, endpoints, like in _misnamed(seen):
        senders = nodes_of(seen.publishers_of(like))
        yield Diagnostic(
            "DOC204",
            phrase(
                "no node publishes topic '{topic}', which {nodes_of} subscribes to, but '{like}' is published",
                topic=topic,
                nodes_of=listed(nodes_of(endpoints)),
                like=like,
            ),
            severity=Severity.WARNING,
            notes=(
                Note(
                    phrase(
                        "'{like}' has the same type, {type_name}, and is published by {senders}",
                        like=like,
                        type_name=type_name,
                        senders=listed(senders),
                    )
                ),
            ),
            hint=phrase(
                "if they belong together, remap one of them: --ros-args -r {topic}:={like}", topic=topic, like=like
            ),
        )


def _unheard_commands(seen: Observation) -> Iterator[Diagnostic]:
    """Yield findings on velocity commands that no node subscribes to."""
    heard = {endpoint.name for endpoint in seen.of_kind(EndpointKind.SUBSCRIPTION)}
    misnamed = {like for _, _, _, like in _misnamed(seen)}
    accepting = {
        endpoint.name for endpoint in seen.of_kind(EndpointKind.SUBSCRIPTION) if endpoint.type_name in _VELOCITIES
    }
    unheard: dict[str, list[EndpointInfo]] = {}
    for endpoint in seen.of_kind(EndpointKind.PUBLISHER):
        name = endpoint.name
        if endpoint.type_name in _VELOCITIES and name.rpartition("/")[2] == _COMMAND and name not in heard | misnamed:
            unheard.setdefault(name, []).append(endpoint)
    for topic, publishers in sorted(unheard.items()):
        hint = (
            phrase(
                "nodes accept velocities on {topics}; remap one side: --ros-args -r {topic}:={other}",
                topics=listed(sorted(accepting)),
                topic=topic,
                other=min(accepting),
            )
            if accepting
            else phrase("is the robot, its simulation or its controller running, and in the same ROS_DOMAIN_ID?")
        )
        yield Diagnostic(
            "DOC207",
            phrase(
                "{nodes_of} publishes velocities on '{topic}', but no node subscribes to it, so nothing moves",
                nodes_of=listed(nodes_of(publishers)),
                topic=topic,
            ),
            severity=Severity.WARNING,
            hint=hint,
        )


def _two_drivers(seen: Observation) -> Iterator[Diagnostic]:
    """Yield findings on nodes that sent contradictory velocities on one topic."""
    for drivers_seen in seen.disputed:
        yield Diagnostic(
            "DOC208",
            phrase(
                "two nodes drive the robot: {drivers} publish velocities on '{topic}'",
                drivers=listed(drivers_seen.drivers),
                topic=drivers_seen.topic,
            ),
            severity=Severity.WARNING,
            notes=(Note(phrase("the robot obeys each message in turn, so it jerks between them")),),
            hint=phrase("stop one of them, or let twist_mux choose between them by priority"),
        )


def _alike(name: str, candidates: list[str]) -> str | None:
    """Return the candidate that is probably meant by a name, or None.

    A candidate matches if only its namespace differs, or if its spelling is similar.
    """
    last = name.rpartition("/")[2]
    same_end = [candidate for candidate in candidates if candidate.rpartition("/")[2] == last]
    near = nearest(name, [candidate for candidate in candidates if abs(len(candidate) - len(name)) <= _MOST_DIFFERENT])
    return next(iter((*same_end, *near)), None)


def _unserved(seen: Observation) -> Iterator[Diagnostic]:
    served = {endpoint.name: endpoint.type_name for endpoint in seen.of_kind(EndpointKind.SERVICE)}
    wanting: dict[tuple[str, str], list[EndpointInfo]] = {}
    for endpoint in seen.of_kind(EndpointKind.CLIENT):
        if served.get(endpoint.name) != endpoint.type_name and "/_action/" not in endpoint.name:
            wanting.setdefault((endpoint.name, endpoint.type_name), []).append(endpoint)
    for (name, type_name), clients in sorted(wanting.items()):
        callers = listed(nodes_of(clients))
        if name in served:
            yield Diagnostic(
                "DOC205",
                phrase(
                    "service '{name}' is called by {callers} as {type_name}, but has the type {served}",
                    name=name,
                    callers=callers,
                    type_name=type_name,
                    served=served[name],
                ),
                hint=phrase("client and server must have the same type"),
            )
            continue
        same_type = [each for each, kind in served.items() if kind == type_name]
        last = name.rpartition("/")[2]
        near = [item for item in same_type if item.rpartition("/")[2] == last] or nearest(name, same_type)
        yield Diagnostic(
            "DOC206",
            phrase("no node provides '{name}', which {callers} calls", name=name, callers=callers),
            severity=Severity.WARNING,
            notes=(Note(phrase("it is of type {type_name}", type_name=type_name)),),
            hint=phrase(
                "'{near}' has that type; remap one of them: --ros-args -r {name}:={near}",
                near=near[0],
                name=name,
            )
            if near
            else phrase("start the node that provides it, or check its name and namespace"),
        )


def examine_lifecycle(seen: Observation) -> Iterator[Diagnostic]:
    """Yield findings on managed nodes that are not active."""
    waiting: dict[str, list[str]] = {}
    for node, state in seen.lifecycle.items():
        if state in ("unconfigured", "inactive"):
            waiting.setdefault(state, []).append(node)
    for state, nodes in sorted(waiting.items()):
        next_one = "configure" if state == "unconfigured" else "activate"
        yield Diagnostic(
            "DOC701",
            phrase("managed node {nodes} is {state}, so it does nothing yet", nodes=listed(sorted(nodes)), state=state),
            severity=Severity.WARNING,
            hint=phrase("bring it up: ros2 lifecycle set {node} {transition}", node=min(nodes), transition=next_one),
        )
