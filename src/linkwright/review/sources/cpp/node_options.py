"""Read the remappings and options that a C++ source passes to its node by ``rclcpp::NodeOptions``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.review.sources.cpp.node_handles import add_namespace

_ARGUMENTS = re.compile(r"(?:\.|->)\s*arguments\s*\(\s*(?:std\s*::\s*vector\s*<[^<>;]*>\s*)?\{(?P<items>[^{};]*)\}")
_ITEM = re.compile(r'"(?P<text>[^"\\]*)"')
_RULE = re.compile(r"(?P<old>[~/\w]+):=(?P<new>[~/\w]+)")
_NAMESPACE = "__ns"
_NODE_NAMES = ("__node", "__name")
_REMAP_OPTIONS = ("-r", "--remap")
_OPTION = re.compile(
    r"(?:\.|->)\s*(?P<name>use_intra_process_comms|start_parameter_services|start_parameter_event_publisher|"
    r"allow_undeclared_parameters|automatically_declare_parameters_from_overrides|use_global_arguments|enable_rosout|"
    r"enable_topic_statistics|use_clock_thread)\s*\(\s*(?P<value>true|false)\s*\)"
)
_EXECUTOR = re.compile(r"\b(?P<name>\w+Executor)\b")
_MAIN = re.compile(r"\bint\s+main\s*\(")
_REGISTRATION = "RCLCPP_COMPONENTS_REGISTER_NODE"
_GENERATED_PROGRAM = re.compile(r"\brclcpp_components_register_node\s*\((?P<arguments>[^()]*)\)")
_DEFAULT_EXECUTOR = "SingleThreadedExecutor"


@dataclass(frozen=True)
class Remappings:
    """The remappings of the only node of a source.

    Attributes:
        names: the new names, by old name without a leading slash.
        namespace: the namespace of the node; empty if the arguments set none.
        node: the name of the node; empty if the arguments set none.
    """

    names: Mapping[str, str] = field(default_factory=dict)
    namespace: str = ""
    node: str = ""

    def resolve(self, name: str) -> str:
        """Return the name that a topic, service or action has in the graph."""
        return add_namespace(self.namespace, self.names.get(name.lstrip("/"), name))


def read_remappings(text: str) -> Remappings:
    """Return the remappings in a C++ source; empty if it has arguments for several nodes.

    Args:
        text: the source without comments.
    """
    matches = list(_ARGUMENTS.finditer(text))
    if len(matches) != 1:
        return Remappings()
    items = [item["text"] for item in _ITEM.finditer(matches[0]["items"])]
    rules: dict[str, str] = {}
    for option, item in pairwise(items):
        rule = _RULE.fullmatch(item) if option in _REMAP_OPTIONS else None
        if rule is not None:
            rules[rule["old"].lstrip("/")] = rule["new"]
    node = next((rules[name] for name in _NODE_NAMES if name in rules), "")
    names = {old: new for old, new in rules.items() if not old.startswith("__")}
    return Remappings(names, rules.get(_NAMESPACE, "").rstrip("/"), node)


@dataclass(frozen=True)
class OptionChange:
    """A change to the options or the executor of a node.

    Attributes:
        text: the change in one line.
        offset: the place in the text of its version.
        is_old: whether only the old version has the option or the executor.
    """

    text: Phrase
    offset: int
    is_old: bool


def find_option_changes(old: str, new: str, reported: Sequence[str]) -> Iterator[OptionChange]:
    """Yield the options of nodes that have another value, if each version gives an option one value.

    Args:
        old: the old source without comments.
        new: the new source without comments.
        reported: the other lines about the source. Options in these lines are left out.
    """
    before, after = _read_options(old), _read_options(new)
    texts, places = list[Phrase](), list[tuple[bool, int]]()
    for name, (values, place) in (*after.items(), *before.items()):
        if any(re.search(rf"{name} ?\(", line) for line in reported):
            continue
        old_value, new_value = (side[name][0] if name in side else set() for side in (before, after))
        if old_value == new_value or max(len(old_value), len(new_value)) > 1 or (values is old_value and new_value):
            continue
        if old_value and new_value:
            texts.append(phrase("{name} {old} -> {new}", name=name, old=min(old_value), new=min(new_value)))
        elif new_value:
            texts.append(phrase("{name} {value} added", name=name, value=min(new_value)))
        else:
            texts.append(phrase("{name} {value} removed", name=name, value=min(old_value)))
        places.append((not new_value, place))
    if texts:
        is_old, place = min(places)
        yield OptionChange(phrase("options of the node: {changes}", changes=joined(texts)), place, is_old)


def find_executor_change(old: str, new: str, build_text: str) -> Iterator[OptionChange]:
    """Yield the executor of a program that the build file makes of a component now, if it is another one.

    Args:
        old: the old source without comments.
        new: the new source without comments.
        build_text: the text of the build file.
    """
    executors = {match["name"]: match.start() for match in _EXECUTOR.finditer(old)}
    is_component = _REGISTRATION in new and _REGISTRATION not in old
    generated = _GENERATED_PROGRAM.findall(build_text)
    is_left = _MAIN.search(old) is not None and _MAIN.search(new) is None and _EXECUTOR.search(new) is None
    if not (is_component and is_left and len(executors) == len(generated) == 1):
        return
    ((name, place),) = executors.items()
    words = generated[0].split()
    made = words[words.index("EXECUTOR") + 1] if "EXECUTOR" in words[:-1] else _DEFAULT_EXECUTOR
    if name != made:
        yield OptionChange(phrase("executor: {old} -> {new}", old=name, new=made), place, is_old=True)


def _read_options(text: str) -> dict[str, tuple[set[str], int]]:
    """Return the values of the options of nodes, each with the place of the first one, by name."""
    options: dict[str, tuple[set[str], int]] = {}
    for match in _OPTION.finditer(text):
        options.setdefault(match["name"], (set(), match.start("name")))[0].add(match["value"])
    return options
