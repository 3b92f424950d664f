"""Find the topics that costmaps no longer read, in parameter files of navigation."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.files.parameters.yaml_values import YamlValue
from linkwright.review.texts.list_changes import EMPTY, list_items

_SOURCES = "observation_sources"
"""The parameter of an obstacle layer, or of a costmap itself, with the names of its sources."""
_LAYER_TOPIC = re.compile(
    r"(?:(?P<costmap>.*costmap[^.]*(?:\.ros__parameters)?)\.(?:.+\.)?|(?:[^.]*_)?layer(?:_[^.]*)?\.)(?:map_topic|topics)"
)
"""The parameters of static and range layers with the topics that they read.

A file that only has the layers, as for ROS 1, belongs to one costmap.
"""

_PLACEHOLDER = re.compile(r"<\w+>")
"""A part of a name that a launch file has to replace."""

FindRemappings = Callable[[], "tuple[Sequence[Mapping[str, str]], Sequence[Mapping[str, str]]]"]


class CostmapTopics:
    """The topics that the costmaps of a parameter file read before and after a change.

    Args:
        old: the old values by path.
        new: the new values by path.
        find_remappings: a function that returns the remappings of the nodes that load either version of the file.
        was_replaced: a function that returns whether an old launch file replaces a placeholder, such as ``<scan>``.
    """

    def __init__(
        self,
        old: Mapping[str, YamlValue],
        new: Mapping[str, YamlValue],
        find_remappings: FindRemappings,
        was_replaced: Callable[[str], bool],
    ) -> None:
        self._old = old
        self._new = new
        self._find_remappings = find_remappings
        self._was_replaced = was_replaced

    def find_reason(self, parameter: str) -> Phrase | None:
        """Return the reason why changing or removing a parameter is breaking, or None if no topic is lost by it."""
        lost = sorted(self._lost_topics.get(parameter, ()))
        if not lost:
            return None
        return phrase("the costmap no longer gets the messages of {names}", names=quoted_names(lost))

    def is_dropped_source(self, parameter: str) -> bool:
        """Return whether a parameter belongs to a source that its layer no longer names."""
        source = _get_parent(parameter)
        layer, _, name = source.rpartition(".")
        owner = _join(layer, _SOURCES)
        if owner not in self._old or name not in _split(self._old[owner].text):
            return False
        if owner in self._new:
            return name not in _split(self._new[owner].text)
        return any(other.startswith(f"{layer}.") for other in self._new)

    def find_replaced_layers(self, parameter: str) -> set[str]:
        """Return the layers that a list of a costmap no longer names, but whose topics other layers of it read.

        Args:
            parameter: the path of the list.
        """
        costmap, _, name = parameter.rpartition(".")
        if name != "plugins" or parameter not in self._new or "costmap" not in costmap:
            return set()
        left = _split(self._new[parameter].text)
        read = {topic for layer in left for topic in _find_layer_topics(self._new, _join(costmap, layer))}
        topics = {layer: _find_layer_topics(self._old, _join(costmap, layer)) for layer in self._list_old(parameter)}
        return {layer for layer, names in topics.items() if layer not in left and names and names <= read}

    def _list_old(self, parameter: str) -> list[str]:
        return _split(self._old[parameter].text) if parameter in self._old else []

    @cached_property
    def _lost_topics(self) -> dict[str, list[str]]:
        """The topics that a costmap no longer reads, by the parameters that named them."""
        lost: dict[str, list[str]] = {}
        for owner, costmap, topic in _list_topics(self._old):
            if any(not self._was_replaced(placeholder) for placeholder in _PLACEHOLDER.findall(topic)):
                continue  # no valid name, so that the costmap got no messages
            if (costmap, topic) not in self._new_topics and not self._keeps_full_name(costmap, topic):
                for parameter in {owner, _get_list_name(owner)}:
                    lost.setdefault(parameter, []).append(topic)
        return lost

    def _keeps_full_name(self, costmap: str, topic: str) -> bool:
        """Return whether a costmap still reads a topic under another name, which all launch files remap to it."""
        old, new = self._remappings
        full_names = {names.get(topic, topic) for names in old}
        topics = {name for owner, name in self._new_topics if owner == costmap}
        return bool(old and new) and all(full_names <= {names.get(name, name) for name in topics} for names in new)

    @cached_property
    def _remappings(self) -> tuple[Sequence[Mapping[str, str]], Sequence[Mapping[str, str]]]:
        return self._find_remappings()

    @cached_property
    def _new_topics(self) -> set[tuple[str, str]]:
        return {(costmap, topic) for _, costmap, topic in _list_topics(self._new)}


def _split(text: str) -> list[str]:
    """Return the names in a list of sources."""
    return re.split(r"[\s,]+", text.strip("[] "))


def _get_list_name(owner: str) -> str:
    """Return the path of the list that names the source with a topic."""
    return _join(_get_parent(_get_parent(owner)), _SOURCES)


def _get_parent(path: str) -> str:
    return path.rpartition(".")[0]


def _join(*parts: str) -> str:
    return ".".join(filter(None, parts))


def _list_topics(values: Mapping[str, YamlValue]) -> Iterator[tuple[str, str, str]]:
    """Yield the path of each parameter with a topic that a costmap reads, the path of the costmap and the topic."""
    for name, value in values.items():
        if name.rpartition(".")[2] == _SOURCES:
            layer = _get_parent(name)
            for source in _split(value.text):
                owner = _find_owner(values, layer, source)
                if owner is not None and values[owner].text:
                    yield owner, _find_costmap(layer), values[owner].text.strip("/")
        match = _LAYER_TOPIC.fullmatch(name)
        for topic_name in list_items(value.text) if match is not None else ():
            if match is not None and topic_name not in ("", EMPTY):
                yield name, match["costmap"] or "", topic_name.strip("/")


def _find_layer_topics(values: Mapping[str, YamlValue], layer: str) -> set[str]:
    """Return the topics that a layer reads."""
    return {topic for owner, _, topic in _list_topics(values) if owner.startswith(f"{layer}.")}


def _find_owner(values: Mapping[str, YamlValue], layer: str, source: str) -> str | None:
    """Return the path of the topic of a source; None if there is none.

    The path of a source that moves to a different layer is the new one in the old values, too.
    """
    owner = _join(layer, source, "topic")
    if owner in values:
        return owner
    costmap = _find_costmap(layer)
    moved = (name for name in values if name.endswith(f".{source}.topic") and _find_costmap(name) == costmap)
    return next(moved, None)


def _find_costmap(layer: str) -> str:
    """Return the path of the costmap of a layer; the costmap itself may have the sources."""
    match = re.match(r".*costmap[^.]*(?:\.ros__parameters)?(?=\.|$)", layer)
    return "" if match is None else match[0]
