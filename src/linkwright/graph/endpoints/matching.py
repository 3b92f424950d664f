"""Whether a publisher and a subscription are compatible, and the warnings both get when they are not."""

from __future__ import annotations

from typing import Any

from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.qos.compatibility import incompatible_policies
from linkwright.graph.qos.profile import QoSPolicyKind, QoSProfile


def match(publisher: Publisher[Any], subscription: Subscription[Any]) -> None:
    """Connect the two, or warn both nodes of the policies that are incompatible."""
    if publisher.type_name != subscription.type_name:
        subscription.node.logger.warning(
            f"Topic '{publisher.name}' has different types: '{publisher.node_name}' publishes "
            f"{publisher.type_name}, '{subscription.node_name}' subscribes to "
            f"{subscription.type_name}. No messages will be received."
        )
        return
    offered, requested = publisher.qos_profile, subscription.qos_profile
    policies = incompatible_policies(offered, requested)
    if not policies:
        publisher.connect(subscription)
        return
    sides = what_sides_say(publisher.node_name, offered, subscription.node_name, requested, policies)
    tell_subscription(subscription, policies[-1].name, sides)
    tell_publisher(publisher, policies[-1].name, sides)


def tell_subscription(subscription: Subscription[Any], policy: str, sides: str) -> None:
    """Tell a subscription of a publisher that offers less than it asks for.

    Args:
        subscription: the subscription.
        policy: the name of the policy.
        sides: what the two sides say of it.
    """
    if subscription.events is not None and subscription.events.incompatible(policy):
        return
    subscription.node.logger.warning(
        f"New publisher discovered on topic '{subscription.name}', offering incompatible QoS. "
        f"No messages will be received from it. Last incompatible policy: {policy}_QOS_POLICY ({sides})"
    )


def tell_publisher(publisher: Publisher[Any], policy: str, sides: str) -> None:
    """Tell a publisher of a subscription that asks for more than it offers; see `tell_subscription`."""
    if publisher.events is not None and publisher.events.incompatible(policy):
        return
    publisher.node.logger.warning(
        f"New subscription discovered on topic '{publisher.name}', requesting incompatible QoS. "
        f"No messages will be sent to it. Last incompatible policy: {policy}_QOS_POLICY ({sides})"
    )


def what_sides_say(
    publisher: str, offered: QoSProfile, subscription: str, requested: QoSProfile, policies: list[QoSPolicyKind]
) -> str:
    """What the two nodes offer and request in the policies that are incompatible."""
    return f"'{publisher}' offers {_terms(offered, policies)}, '{subscription}' requests {_terms(requested, policies)}"


def _terms(qos: QoSProfile, policies: list[QoSPolicyKind]) -> str:
    return ", ".join(_term(qos, policy) for policy in policies)


def _term(qos: QoSProfile, policy: QoSPolicyKind) -> str:
    if policy is QoSPolicyKind.RELIABILITY:
        return _words(qos.reliability.name)
    if policy is QoSPolicyKind.DURABILITY:
        return _words(qos.durability.name)
    if policy is QoSPolicyKind.DEADLINE:
        return f"a deadline of {qos.deadline}"
    return f"{_words(qos.liveliness.name)} liveliness with a lease of {qos.liveliness_lease_duration}"


def _words(name: str) -> str:
    return name.lower().replace("_", " ")
