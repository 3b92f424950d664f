"""Names of topics, nodes and namespaces: expansion, validation and remapping."""

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import (
    InvalidNameError,
    InvalidNamespaceError,
    InvalidNodeNameError,
    InvalidServiceNameError,
    InvalidTopicNameError,
)
from linkwright.graph.names.rules import is_hidden
from linkwright.messages import String


@pytest.mark.parametrize(
    ("namespace", "topic", "resolved"),
    [
        ("/", "chatter", "/chatter"),
        ("/", "/chatter", "/chatter"),
        ("/", "~/chatter", "/node/chatter"),
        ("/", "~", "/node"),
        ("/robot", "chatter", "/robot/chatter"),
        ("robot", "a/b", "/robot/a/b"),
        ("/robot", "/tf", "/tf"),
        ("/robot", "~/state", "/robot/node/state"),
        ("/robot", "{node}/x", "/robot/node/x"),
        ("/robot", "{ns}/x", "/robot/x"),
    ],
)
async def test_topic_names_are_expanded(graph, namespace, topic, resolved):
    node = graph.create_node("node", namespace=namespace)
    assert node.resolve_topic_name(topic) == resolved
    assert node.create_publisher(String, topic, 1).topic_name == resolved


@pytest.mark.parametrize(
    ("topic", "reason"),
    [
        ("", "topic name must not be empty string"),
        ("a/", "topic name must not end with a forward slash"),
        ("my topic", "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'"),
        ("a//b", "topic name must not contain repeated '/'"),
        ("3d", "topic name token must not start with a number"),
        ("a/3d", "topic name token must not start with a number"),
        ("a~", "topic name must not have tilde '~' unless it is the first character"),
        ("~a", "topic name must not have a tilde '~' that is not followed by a forward slash '/'"),
        ("{node", "topic name must not have unmatched (unbalanced) curly braces '{}'"),
        ("{robot}/x", "unknown substitution '{robot}'"),
    ],
)
async def test_invalid_topic_names_are_rejected_with_reason(graph, topic, reason):
    with pytest.raises(InvalidNameError) as caught:
        graph.create_node("node").create_subscription(String, topic, print, 1)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "GRAPH101"
    assert diagnostic.message == f"'{topic}' is not a valid topic name: {reason}"


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("", "must not be empty"),
        ("my node", "must not contain characters other than alphanumerics or '_'"),
        ("a/b", "must not contain characters"),
        ("2nd", "must not start with a number"),
        ("x" * 256, "length should not exceed '255'"),
    ],
)
async def test_invalid_node_names_are_rejected_with_reason(graph, name, reason):
    with pytest.raises(InvalidNameError, match="is not a valid node name: node name") as caught:
        graph.create_node(name)
    assert reason in str(caught.value)


@pytest.mark.parametrize("namespace", ["/a/", "a b", "/a//b", "/1st"])
async def test_invalid_namespaces_are_rejected(graph, namespace):
    with pytest.raises(InvalidNameError, match="is not a valid namespace"):
        graph.create_node("node", namespace=namespace)


@pytest.mark.parametrize(
    ("rules", "topic", "resolved"),
    [
        ([("chatter", "talk")], "chatter", "/robot/talk"),
        ([("chatter", "/talk")], "/robot/chatter", "/talk"),
        ([("/chatter", "/talk")], "chatter", "/robot/chatter"),
        ([("~/state", "~/status")], "~/state", "/robot/node/status"),
        ([("/tf", "tf"), ("/tf_static", "tf_static")], "/tf", "/robot/tf"),
        ([("chatter", "first"), ("chatter", "second")], "chatter", "/robot/first"),
        ([("first", "second"), ("chatter", "first")], "chatter", "/robot/first"),
    ],
)
async def test_remap_rules_apply_to_topics(graph, rules, topic, resolved):
    node = graph.create_node("node", namespace="/robot", remappings=rules)
    assert node.resolve_topic_name(topic) == resolved


async def test_node_is_renamed_by_remap_rules(graph):
    rules = [("__node", "other"), ("__ns", "/there"), ("~/x", "~/y")]
    node = graph.create_node("node", namespace="/here", remappings=rules)
    assert node.get_fully_qualified_name() == "/there/other"
    assert (node.get_namespace(), node.get_name()) == ("/there", "other")
    assert node.get_logger().name == "there.other"
    assert node.resolve_topic_name("~/x") == "/there/other/y"


async def test_invalid_remap_target_is_rejected(graph):
    node = graph.create_node("node", remappings=[("chatter", "two words")])
    with pytest.raises(InvalidNameError, match="'two words' is not a valid topic name"):
        node.create_publisher(String, "chatter", 1)


async def test_invalid_names_raise_specific_errors(graph):
    node = graph.create_node("node")
    cases = [
        (InvalidTopicNameError, "topic name", 1, lambda: node.create_publisher(String, "a b", 1)),
        (InvalidServiceNameError, "service name", 1, lambda: node.resolve_service_name("a b")),
        (InvalidNodeNameError, "node name", 1, lambda: graph.create_node("a b")),
        (InvalidNamespaceError, "namespace", 2, lambda: graph.create_node("node", namespace="a b")),
    ]
    for kind, words, index, mistake in cases:
        with pytest.raises(kind) as caught:
            mistake()
        assert caught.value.kind == words
        assert caught.value.name == "a b"
        assert caught.value.invalid_index == index
        assert "must not contain characters" in caught.value.error_msg


@pytest.mark.parametrize(
    ("rules", "topic", "service"),
    [
        ([("node:name", "new")], "/new", "/new"),
        ([("other:name", "new")], "/name", "/name"),
        ([("rostopic://name", "new")], "/new", "/name"),
        ([("rosservice://name", "new")], "/name", "/new"),
        ([("node:rosservice://name", "rosservice://new")], "/name", "/new"),
        ([("rosservice://name", "one"), ("name", "two")], "/two", "/one"),
    ],
)
async def test_remap_rules_can_target_one_node_or_kind(graph, rules, topic, service):
    node = graph.create_node("node", remappings=rules)
    assert (node.resolve_topic_name("name"), node.resolve_service_name("name")) == (topic, service)
    assert node.resolve_topic_name("name", only_expand=True) == "/name"


async def test_remap_rule_renames_only_matching_node(graph):
    rules = [("first:__node", "renamed"), ("second:__ns", "/away")]
    names = [graph.create_node(name, remappings=rules).get_fully_qualified_name() for name in ("first", "second")]
    assert names == ["/renamed", "/away/second"]


async def test_wildcards_in_remap_rules_are_rejected(graph):
    with pytest.raises(LinkwrightError) as caught:
        graph.create_node("node", remappings=[("/*/chatter", "/talk")])
    assert caught.value.diagnostics[0].code == "GRAPH102"


@pytest.mark.parametrize(
    ("name", "hidden"), [("/chatter", False), ("/_hidden", True), ("/a/_action/status", True), ("/a_b", False)]
)
def test_hidden_names_are_recognized(name, hidden):
    assert is_hidden(name) is hidden
