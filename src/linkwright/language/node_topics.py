"""The topics, services and actions of nodes that a launch file can remap.

The names of Linkwright's nodes come from ``linkwright.nodes.recorded_names``. The names of other nodes come from the
sources of the workspace.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from linkwright.language.completion import Completion, ItemKind
from linkwright.language.format import Document, Target
from linkwright.language.includes import real_path
from linkwright.language.programs import find_programs
from linkwright.language.source_declarations import declared_topics
from linkwright.nodes.recorded_names import load_topics
from linkwright.packages.share_layout import find_source


class NodeProgram(NamedTuple):
    """The program of a node in a launch file.

    Attributes:
        package: its package, or empty if it is unknown.
        executable: the executable, or empty for a component.
    """

    package: str
    executable: str


@dataclass(frozen=True, slots=True)
class NodeTopic:
    """A topic, service or action of a node.

    Attributes:
        name: the name in the program.
        type: its type, or empty.
        role: the role of the node, such as ``publisher`` or ``action server``.
        target: the location in the sources that creates it, or None if it is unknown.
    """

    name: str
    type: str
    role: str
    target: Target | None = None

    @property
    def key(self) -> str:
        """The name without a leading ``/`` or ``~/``, for comparison with other forms."""
        return plain_name(self.name)


def plain_name(name: str) -> str:
    """Return a name without a leading ``/`` or ``~/``."""
    return name.lstrip("~").lstrip("/")


def node_name(package: str, executable: str) -> str:
    """Return the default name of a program's node, or empty if it is unknown."""
    entry = load_topics().get(f"{package}/{executable}")
    return "" if entry is None else str(entry["node"])


def find_topics(document: Document, programs: Iterable[NodeProgram]) -> list[NodeTopic]:
    """Return the topics, services and actions of some nodes, each once.

    Args:
        document: the launch file.
        programs: the programs of the nodes.

    Raises:
        NotYetKnownError: the sources of the workspace were never read, and the document does not wait.
    """
    topics: dict[tuple[str, str], NodeTopic] = {}
    for program in programs:
        for topic in (*_recorded_topics(program), *_topics_in_sources(document, program)):
            topics.setdefault((topic.key, topic.role), topic)
    return list(topics.values())


def _recorded_topics(program: NodeProgram) -> Iterator[NodeTopic]:
    for name, entry in load_topics().items():
        package, _, executable = name.partition("/")
        if program.package in ("", package) and program.executable in ("", executable):
            yield from (NodeTopic(*topic) for topic in entry["topics"])


def _topics_in_sources(document: Document, program: NodeProgram) -> Iterator[NodeTopic]:
    share = document.finder.find(program.package) if program.package else None
    if share is None or not share.is_dir():
        return
    installed_program = find_programs(document.finder, program.package).get(program.executable)
    file = None if installed_program is None or installed_program.target is None else installed_program.target.file
    folder = real_path(find_source(str(share / "package.xml"))).parent
    for topic in declared_topics(document, file if file is not None and file.suffix == ".py" else folder):
        end = topic.start + len(topic.name)
        yield NodeTopic(topic.name, topic.type, topic.role, Target(topic.file, topic.start, end))


def offer_topics(
    document: Document, programs: Sequence[NodeProgram], typed: str, start: int, remapped: Iterable[str] = ()
) -> Iterator[Completion]:
    """Yield the names that can be remapped in some nodes, in the form that is being typed.

    Args:
        document: the launch file.
        programs: the programs of the nodes.
        typed: the typed part of the name.
        start: its offset.
        remapped: the names that have a remapping already.
    """
    present = {plain_name(name) for name in remapped}
    for topic in find_topics(document, programs):
        if topic.key not in present:
            present.add(topic.key)
            yield Completion(_match_form(topic.name, typed), ItemKind.NAME, start, topic.role, describe_topic(topic))


def _match_form(name: str, typed: str) -> str:
    if typed.startswith("~"):
        return f"~/{plain_name(name)}"
    return f"/{plain_name(name)}" if typed.startswith("/") else name if not typed else name.lstrip("/")


def describe_topic(topic: NodeTopic) -> str:
    """Return the type and role of a topic, in Markdown."""
    file_suffix = "" if topic.target is None else f", {topic.target.file.name}"
    return f"**{topic.name}** `{topic.type}`, {topic.role}{file_suffix}".replace(" ``", "")


def explain_topic(document: Document, programs: Sequence[NodeProgram], name: str) -> str:
    """Return the uses of a topic, service or action by some nodes in Markdown, or empty."""
    topics = [topic for topic in find_topics(document, programs) if topic.key == plain_name(name)]
    return "\n\n".join(map(describe_topic, topics))


def find_topic_targets(document: Document, programs: Sequence[NodeProgram], name: str) -> Iterator[Target]:
    """Yield the locations in the sources that create a topic, service or action."""
    for topic in find_topics(document, programs):
        if topic.key == plain_name(name) and topic.target is not None:
            yield topic.target
