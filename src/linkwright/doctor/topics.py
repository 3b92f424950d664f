"""Problems of nodes, topics and services.

The problems are wrong names and types, incompatible QoS, and managed nodes that are not active.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, nearest, phrase
from linkwright.doctor.record import TWIST, TWIST_STAMPED, Observation, format_names, get_node_name, list_node_names
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.qos.compatibility import find_incompatible_policies
from linkwright.graph.qos.profile import QoSPolicyKind

_COMMAND_TOPIC = "cmd_vel"
"""The last component of topic names for velocity commands.

Other topics often have no subscriber.
"""
_VELOCITY_TYPES = (TWIST, TWIST_STAMPED)
_UNIVERSAL_TOPICS = frozenset({"/parameter_events", "/rosout", "/clock"})
"""Topics that nodes subscribe to even if no node publishes them."""
_MAX_LENGTH_DIFFERENCE = 3
"""The maximum difference in length between a name and its misspelling."""


def examine_topics(observation: Observation) -> Iterator[Diagnostic]:
    """Yield findings about nodes, topics and services."""
    yield from _examine_names(observation)
    yield from _examine_types(observation)
    yield from _examine_qos(observation)
    yield from _examine_misnamed_topics(observation)
    yield from _examine_commands(observation)
    yield from _examine_commanders(observation)
    yield from _examine_clients(observation)


def _examine_names(observation: Observation) -> Iterator[Diagnostic]:
    for name, count in sorted(Counter(observation.nodes).items()):
        if count > 1:
            yield Diagnostic(
                "DOC101",
                phrase("{count} nodes have the name '{name}'", count=count, name=name),
                severity=Severity.WARNING,
                notes=(
                    Note(
                        phrase(
                            "the parameter services of these nodes respond in turn, so a command reaches a random node"
                        )
                    ),
                ),
                hint=phrase(
                    "stop the node that is still running from before, or rename one of them: --ros-args -r "
                    "__node:=OTHER"
                ),
            )


def _examine_types(observation: Observation) -> Iterator[Diagnostic]:
    by_topic: dict[str, dict[str, list[EndpointInfo]]] = {}
    for endpoint in (
        *observation.endpoints_of_kind(EndpointKind.PUBLISHER),
        *observation.endpoints_of_kind(EndpointKind.SUBSCRIPTION),
    ):
        by_topic.setdefault(endpoint.name, {}).setdefault(endpoint.type_name, []).append(endpoint)
    for topic, all_types in sorted(by_topic.items()):
        types = _drop_universal_subscribers(all_types)
        if len(types) < 2:
            continue
        notes = tuple(
            note for name, endpoints in sorted(types.items()) for note in _make_endpoint_notes(endpoints, name)
        )
        if set(types) == {TWIST, TWIST_STAMPED}:
            yield Diagnostic(
                "DOC202",
                phrase(
                    "topic '{topic}' carries Twist for some nodes and TwistStamped for others, so nothing moves",
                    topic=topic,
                ),
                notes=notes,
                hint=phrase(
                    "use one of the two types; many controllers have a parameter for the type (use_stamped_vel, "
                    "enable_stamped_cmd_vel, stamped), and teleop_twist_keyboard has stamped:=true"
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


def _drop_universal_subscribers(types: dict[str, list[EndpointInfo]]) -> dict[str, list[EndpointInfo]]:
    """Return a topic's endpoints by type, without subscriptions of nodes that accept any type.

    A node accepts all types if it subscribes to more than one type, and to all published types. Its publishers remain.
    The result is empty if no other node subscribes.
    """
    all_endpoints = [endpoint for endpoints in types.values() for endpoint in endpoints]
    published_types = {endpoint.type_name for endpoint in all_endpoints if endpoint.kind is EndpointKind.PUBLISHER}
    subscribed_types: dict[str, set[str]] = {}
    for endpoint in all_endpoints:
        if endpoint.kind is EndpointKind.SUBSCRIPTION:
            subscribed_types.setdefault(get_node_name(endpoint), set()).add(endpoint.type_name)
    universal_subscribers = {
        node for node, names in subscribed_types.items() if len(names) > 1 and names >= published_types
    }
    if universal_subscribers and universal_subscribers == set(subscribed_types):
        return {}
    remaining: dict[str, list[EndpointInfo]] = {}
    for endpoint in all_endpoints:
        if endpoint.kind is EndpointKind.PUBLISHER or get_node_name(endpoint) not in universal_subscribers:
            remaining.setdefault(endpoint.type_name, []).append(endpoint)
    return remaining


def _make_endpoint_notes(endpoints: list[EndpointInfo], type_name: str) -> Iterator[Note]:
    publishers = list_node_names(endpoint for endpoint in endpoints if endpoint.kind is EndpointKind.PUBLISHER)
    if publishers:
        yield Note(
            phrase("{type_name} is published by {publishers}", type_name=type_name, publishers=format_names(publishers))
        )
    subscribers = list_node_names(endpoint for endpoint in endpoints if endpoint.kind is EndpointKind.SUBSCRIPTION)
    if subscribers:
        yield Note(
            phrase(
                "{type_name} is subscribed to by {subscribers}",
                type_name=type_name,
                subscribers=format_names(subscribers),
            )
        )


def _examine_qos(observation: Observation) -> Iterator[Diagnostic]:
    if observation.over_zenoh:
        return
    publishers = observation.endpoints_of_kind(EndpointKind.PUBLISHER)
    reported = set()
    for subscription in observation.endpoints_of_kind(EndpointKind.SUBSCRIPTION):
        for publisher in publishers:
            if publisher.name != subscription.name or publisher.type_name != subscription.type_name:
                continue
            policies = tuple(find_incompatible_policies(publisher.qos, subscription.qos))
            key = (publisher.name, get_node_name(publisher), get_node_name(subscription), policies)
            if policies and key not in reported:
                reported.add(key)
                yield _make_qos_finding(publisher, subscription, policies)


def _make_qos_finding(
    publisher: EndpointInfo, subscription: EndpointInfo, policies: tuple[QoSPolicyKind, ...]
) -> Diagnostic:
    sender, receiver = get_node_name(publisher), get_node_name(subscription)
    notes = []
    for policy in policies:
        name = policy.name.lower()
        offered, requested = _format_policy(publisher, policy), _format_policy(subscription, policy)
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
            "'{receiver}' receives nothing from '{sender}' on topic '{name}', because their quality of service "
            "is incompatible",
            receiver=receiver,
            sender=sender,
            name=publisher.name,
        ),
        notes=tuple(notes),
        hint=_make_qos_hint(policies[0]),
    )


def _make_qos_hint(policy: QoSPolicyKind) -> Phrase:
    if policy is QoSPolicyKind.RELIABILITY:
        return phrase(
            "make the publisher reliable, or the subscription best effort (in RViz: the display's Reliability Policy)"
        )
    if policy is QoSPolicyKind.DURABILITY:
        return phrase(
            "make the publisher transient local, or the subscription volatile (in RViz: the display's "
            "Durability Policy)"
        )
    return phrase("let the publisher offer a stricter policy, or the subscription request a weaker one")


def _format_policy(endpoint: EndpointInfo, policy: QoSPolicyKind) -> str:
    """Return the value of an endpoint's QoS policy as text, such as ``RELIABLE``."""
    value = getattr(endpoint.qos, policy.name.lower())
    if policy is QoSPolicyKind.LIVELINESS:
        return f"{value.name} ({endpoint.qos.liveliness_lease_duration})"
    return str(getattr(value, "name", value))


def _find_misnamed_topics(observation: Observation) -> Iterator[tuple[str, str, list[EndpointInfo], str]]:
    """Yield unpublished topics whose subscribers probably mean another topic.

    Yields:
        The topic, its type, its subscriptions, and the name of the published topic.
    """
    published_types: dict[str, set[str]] = {}
    senders: dict[str, set[str]] = {}
    for endpoint in observation.endpoints_of_kind(EndpointKind.PUBLISHER):
        published_types.setdefault(endpoint.name, set()).add(endpoint.type_name)
        senders.setdefault(endpoint.name, set()).add(get_node_name(endpoint))
    subscriptions: dict[tuple[str, str], list[EndpointInfo]] = {}
    for endpoint in observation.endpoints_of_kind(EndpointKind.SUBSCRIPTION):
        if (
            endpoint.name not in published_types
            and endpoint.name not in _UNIVERSAL_TOPICS
            and "/_action/" not in endpoint.name
        ):
            subscriptions.setdefault((endpoint.name, endpoint.type_name), []).append(endpoint)
    subscribed_topics = {endpoint.name for endpoint in observation.endpoints_of_kind(EndpointKind.SUBSCRIPTION)}
    for (topic, type_name), endpoints in sorted(subscriptions.items()):
        # A published topic with a subscriber is probably meant for that one. In addition, no node means to subscribe
        # to its own topic.
        subscribers = set(list_node_names(endpoints))
        unsubscribed_topics = [
            name
            for name, types in published_types.items()
            if type_name in types and name not in subscribed_topics and not subscribers & senders[name]
        ]
        published_topic = _find_similar(topic, unsubscribed_topics)
        if published_topic is not None:
            yield topic, type_name, endpoints, published_topic


def _examine_misnamed_topics(observation: Observation) -> Iterator[Diagnostic]:
    for topic, type_name, endpoints, published_topic in _find_misnamed_topics(observation):
        senders = list_node_names(observation.find_publishers(published_topic))
        yield Diagnostic(
            "DOC204",
            phrase(
                "no node publishes topic '{topic}', which {subscribers} subscribes to, "
                "but '{similar_topic}' is published",
                topic=topic,
                subscribers=format_names(list_node_names(endpoints)),
                similar_topic=published_topic,
            ),
            severity=Severity.WARNING,
            notes=(
                Note(
                    phrase(
                        "'{similar_topic}' has the same type, {type_name}, and is published by {senders}",
                        similar_topic=published_topic,
                        type_name=type_name,
                        senders=format_names(senders),
                    )
                ),
            ),
            hint=phrase(
                "if the two topics belong together, remap one of them: --ros-args -r {topic}:={similar_topic}",
                topic=topic,
                similar_topic=published_topic,
            ),
        )


def _examine_commands(observation: Observation) -> Iterator[Diagnostic]:
    """Yield findings about velocity commands that no node receives."""
    subscribed_topics = {endpoint.name for endpoint in observation.endpoints_of_kind(EndpointKind.SUBSCRIPTION)}
    misnamed_topics = {similar_topic for _, _, _, similar_topic in _find_misnamed_topics(observation)}
    command_topics = {
        endpoint.name
        for endpoint in observation.endpoints_of_kind(EndpointKind.SUBSCRIPTION)
        if endpoint.type_name in _VELOCITY_TYPES
    }
    unsubscribed: dict[str, list[EndpointInfo]] = {}
    for endpoint in observation.endpoints_of_kind(EndpointKind.PUBLISHER):
        name = endpoint.name
        if (
            endpoint.type_name in _VELOCITY_TYPES
            and name.rpartition("/")[2] == _COMMAND_TOPIC
            and name not in subscribed_topics | misnamed_topics
        ):
            unsubscribed.setdefault(name, []).append(endpoint)
    for topic, publishers in sorted(unsubscribed.items()):
        hint = (
            phrase(
                "nodes accept velocities on {topics}; remap the topic: --ros-args -r {topic}:={other}",
                topics=format_names(sorted(command_topics)),
                topic=topic,
                other=min(command_topics),
            )
            if command_topics
            else phrase("check that the robot, its simulation or its controller runs in the same ROS_DOMAIN_ID")
        )
        yield Diagnostic(
            "DOC207",
            phrase(
                "{publishers} publishes velocities on '{topic}', but no node subscribes to it, so nothing moves",
                publishers=format_names(list_node_names(publishers)),
                topic=topic,
            ),
            severity=Severity.WARNING,
            hint=hint,
        )


def _examine_commanders(observation: Observation) -> Iterator[Diagnostic]:
    """Yield findings about nodes that published contradictory velocities on a topic."""
    for observed_drivers in observation.contradictory_velocities:
        yield Diagnostic(
            "DOC208",
            phrase(
                "two nodes drive the robot: {drivers} publish contradictory velocities on '{topic}'",
                drivers=format_names(observed_drivers.commanders),
                topic=observed_drivers.topic,
            ),
            severity=Severity.WARNING,
            notes=(Note(phrase("the robot obeys each message in turn, so its motion is jerky")),),
            hint=phrase("stop one of them, or let twist_mux choose between them by priority"),
        )


def _find_similar(name: str, candidates: list[str]) -> str | None:
    """Return the candidate that a misspelled name probably means, or None.

    A candidate is suitable if only its namespace differs, or if its spelling is similar.
    """
    base_name = name.rpartition("/")[2]
    same_base_name = [candidate for candidate in candidates if candidate.rpartition("/")[2] == base_name]
    similar_names = nearest(
        name, [candidate for candidate in candidates if abs(len(candidate) - len(name)) <= _MAX_LENGTH_DIFFERENCE]
    )
    return next(iter((*same_base_name, *similar_names)), None)


def _examine_clients(observation: Observation) -> Iterator[Diagnostic]:
    service_types = {
        endpoint.name: endpoint.type_name for endpoint in observation.endpoints_of_kind(EndpointKind.SERVICE)
    }
    clients_by_service: dict[tuple[str, str], list[EndpointInfo]] = {}
    for endpoint in observation.endpoints_of_kind(EndpointKind.CLIENT):
        if service_types.get(endpoint.name) != endpoint.type_name and "/_action/" not in endpoint.name:
            clients_by_service.setdefault((endpoint.name, endpoint.type_name), []).append(endpoint)
    for (name, type_name), clients in sorted(clients_by_service.items()):
        callers = format_names(list_node_names(clients))
        if name in service_types:
            yield Diagnostic(
                "DOC205",
                phrase(
                    "service '{name}' is called by {callers} as {type_name}, but has the type {service_type}",
                    name=name,
                    callers=callers,
                    type_name=type_name,
                    service_type=service_types[name],
                ),
                hint=phrase("use the same type for the client and the server"),
            )
            continue
        same_type = [service for service, service_type in service_types.items() if service_type == type_name]
        base_name = name.rpartition("/")[2]
        similar_services = [item for item in same_type if item.rpartition("/")[2] == base_name] or nearest(
            name, same_type
        )
        yield Diagnostic(
            "DOC206",
            phrase("no node provides service '{name}', which {callers} calls", name=name, callers=callers),
            severity=Severity.WARNING,
            notes=(Note(phrase("it is of type {type_name}", type_name=type_name)),),
            hint=phrase(
                "service '{similar_service}' has the same type; "
                "remap one of them: --ros-args -r {name}:={similar_service}",
                similar_service=similar_services[0],
                name=name,
            )
            if similar_services
            else phrase("start the node that provides it, or check its name and namespace"),
        )


def examine_lifecycle(observation: Observation) -> Iterator[Diagnostic]:
    """Yield findings about managed nodes that are not active."""
    nodes_by_state: dict[str, list[str]] = {}
    for node, state in observation.lifecycle.items():
        if state in ("unconfigured", "inactive"):
            nodes_by_state.setdefault(state, []).append(node)
    for state, nodes in sorted(nodes_by_state.items()):
        transition = "configure" if state == "unconfigured" else "activate"
        yield Diagnostic(
            "DOC701",
            phrase(
                "managed node {nodes} is {state}, so it does nothing yet",
                nodes=format_names(sorted(nodes)),
                state=state,
            ),
            severity=Severity.WARNING,
            hint=phrase(
                "request the next transition: ros2 lifecycle set {node} {transition}",
                node=min(nodes),
                transition=transition,
            ),
        )
