"""Compare worlds and models in SDF."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from linkwright.descriptions.comparison import Difference, ElementComparison
from linkwright.diagnostics import LinkwrightError, Phrase, joined, phrase
from linkwright.review.breaking import find_plugin_name_reason, world_reason
from linkwright.review.changes import Change, Location
from linkwright.review.drawings.scene_images import build_world_scenes, read_worlds, render_worlds
from linkwright.review.file_pair import FilePair
from linkwright.review.files.parameters.merged_paths import MergedPaths, to_path_pattern, trim_common_words
from linkwright.review.files.worlds.sdf_contents import (
    format_added_element,
    join_contents,
    summarize_element,
    summarize_shapes_and_mass,
)
from linkwright.review.files.worlds.sdf_defaults import find_default
from linkwright.review.files.worlds.sdf_figures import compare_model_figures
from linkwright.review.files.worlds.sdf_numbers import (
    InertialDifference,
    drop_equal_values,
    drop_rounding,
    join_inertials,
    parse_numbers,
)
from linkwright.review.files.worlds.spawned_models import POSE_LENGTH, SpawnedModel
from linkwright.review.files.worlds.template_macros import PARAMETERS, find_parameters_reason
from linkwright.review.files.worlds.templates import is_template, may_be_equal, read_template
from linkwright.review.joint_limits import find_written_reason
from linkwright.review.left_names import find_left_names
from linkwright.review.names_in_plugins import find_old_path
from linkwright.review.plugins import (
    find_added_topics,
    find_default_topic_reason,
    find_missing_topics_reason,
    find_offered_topics,
    format_contents,
    is_added,
    is_removed,
    is_same_sensor_topic,
    is_still_offered,
)
from linkwright.review.renames.replaced_plugins import PluginReplacement, merge_replaced_plugins
from linkwright.review.renames.sensors import merge_sensor_frames
from linkwright.review.texts.element_values import format_own_content
from linkwright.review.texts.excerpts import differing_excerpts
from linkwright.review.texts.motions import add_pose_motion
from linkwright.review.versions import Version, Versions
from linkwright.sdf.text import parse_as_gazebo
from linkwright.xmltree import Element
from linkwright.xmltree.reader import read_bytes

_WORLD_SUFFIX = ".world"
"""The suffix of worlds of Gazebo Classic, and of those of Stage."""
_NAMED_TAGS = ("world", "model", "include", "link", "joint", "sensor", "frame")
_NAMED_ELEMENT = re.compile(rf"(?:^|.* )(?P<tag>{'|'.join(_NAMED_TAGS)}) (?P<name>\S+)")
"""The path of an element whose name programs and other models use."""
_USED_TAGS = frozenset({"collision", "sensor", "joint", "plugin", "include", "frame", "light"})
"""The parts of a static model that other programs and models use. A model of visuals only can be seen in the window."""
_MODEL_PATH = re.compile(r"(?:world \S+ )?(?:model|include) (?P<name>\S+)")
"""The path of a model of a world."""
_STATE_PATH = re.compile(r"(?:world \S+ )?state (?:\S+ )?model (?P<name>\S+)")
"""The path of the state of a model, or of a part of it."""
_POSE = " pose"
_INCLUDED_NAME = re.compile(r"(?:^|.* )include \S+ name")
"""The path of the name of an included model."""
_JOINT_LIMIT = re.compile(r"\bjoint (?P<name>\S+) axis2? limit (?P<side>lower|upper)$")
"""The path of a position limit of a joint."""
_SET_VARIABLE = re.compile(r"(?:^|.* )set [\w.]+(?: \d+)?")
"""The path of a variable that a template sets. Its name does not show the use of the value."""
_TEMPLATE_VALUE = re.compile(r"\{\{[^{}]*\}\}")
"""A value that a template computes. The names that it gives are unknown."""
_INVISIBLE_TAGS = frozenset(
    {"collision", "inertial", "plugin", "sensor", "physics", "axis", "light", "gravity", "scene", "gui", "static"}
)
"""The tags of elements that images do not show, with their contents."""
_MIN_EQUAL_CHANGES = 3
"""The minimum number of equal changes to different elements that are summarized in one line."""


def is_other_world(file: Path) -> bool:
    """Return whether a world is not XML, such as one of Stage."""
    try:
        return file.suffix == _WORLD_SUFFIX and b"<" not in file.read_bytes()
    except OSError:
        return False


def compare_worlds(pair: FilePair, find_spawned_models: Callable[[Versions, str], Mapping[str, SpawnedModel]]) -> None:
    """Compare two versions of a file in SDF, without the models that it includes.

    Args:
        pair: both versions of the file.
        find_spawned_models: a function that returns the models which launch files newly spawn in a world, by name.
    """
    elements = pair.read(_read_elements)
    if elements is None:
        return
    changed = drop_equal_values(ElementComparison().child_differences(*elements))
    joined_differences = list(join_inertials(drop_rounding(changed)))
    topics = find_added_topics(joined_differences)
    pair.added_topics |= find_offered_topics(joined_differences)
    differences = _drop_states_of_lost_models(merge_sensor_frames(merge_replaced_plugins(joined_differences)))
    changes = [
        _WorldChange(difference, _find_breaking_reason(difference, topics, elements[1])) for difference in differences
    ]
    changes = _mark_spawned_models(changes, lambda: find_spawned_models(pair.versions, pair.new_path))
    separate: list[_WorldChange] = []
    for group in _group_equal_changes(changes):
        parts = trim_common_words([change.path for change in group])
        if len(group) < _MIN_EQUAL_CHANGES or not any(" " in part for part in parts):
            separate += group
            continue
        locations = tuple(location for change in group[1:] if (location := change.location(pair)) is not None)
        first = group[0]
        text = _describe_difference(first.difference, first.path)
        pair.changes.append(
            Change(text, location=first.location(pair), other_names=tuple(parts[1:]), other_locations=locations)
        )
    _report_separately(pair, separate)
    pair.changes += _find_left_names(pair, *elements)
    if differences and not is_template(pair.new_path):
        _report_scenes(pair, may_be_visible=any(map(_may_be_visible, differences)))


def _drop_states_of_lost_models(differences: Sequence[Difference]) -> list[Difference]:
    """Return the differences without the states of models that only one version has."""
    lost = {match["name"] for match in map(_MODEL_PATH.fullmatch, map(_join_path, differences)) if match is not None}
    states = {id(item): match["name"] for item in differences if (match := _STATE_PATH.match(_join_path(item)))}
    return [item for item in differences if states.get(id(item)) not in lost]


def _join_path(difference: Difference) -> str:
    return f"{difference.name} {difference.property}".strip()


def _mark_spawned_models(
    changes: Sequence[_WorldChange], find_models: Callable[[], Mapping[str, SpawnedModel]]
) -> list[_WorldChange]:
    """Return the changes, in which a model that a launch file spawns instead breaks nothing."""
    removed = {
        number: match["name"]
        for number, change in enumerate(changes)
        if is_removed(change.difference) and change.difference.element is not None
        if (match := _MODEL_PATH.fullmatch(change.path)) is not None
    }
    spawned = find_models() if removed else {}
    result = list(changes)
    for number, name in removed.items():
        element = changes[number].difference.element
        if name in spawned and element is not None:
            text = spawned[name].describe_move(changes[number].path, element)
            result[number] = replace(changes[number], reason=None, text=text)
    return result


def _find_left_names(pair: FilePair, old: Sequence[Element], new: Sequence[Element]) -> Iterator[Change]:
    """Yield the plugins and sensors that name a removed link or joint.

    The name may exist in a model that only the new version includes.
    """
    old_links, old_joints, old_models = (_find_names(old, tag) for tag in ("link", "joint", "include"))
    new_links, new_joints, new_models = (_find_names(new, tag) for tag in ("link", "joint", "include"))
    if new_models <= old_models:
        yield from find_left_names(new, old_links - new_links, old_joints - new_joints, pair.location)


def _find_names(elements: Sequence[Element], tag: str) -> set[str]:
    """Return the names of all elements with a tag, or the URIs of included models."""
    tagged = (descendant for element in elements for descendant in element.walk() if descendant.tag == tag)
    if tag == "include":
        return {uri.text().strip() for include in tagged for uri in include.elements("uri")}
    return {named.attributes["name"] for named in tagged if "name" in named.attributes}


def _report_scenes(pair: FilePair, *, may_be_visible: bool) -> None:
    """Report the quantities of a model and images. Both need the included models."""
    worlds = read_worlds(pair)
    if worlds is None:
        return
    is_drawn = may_be_visible and (pair.drawings.images or not any(world.worlds for world in worlds))
    scenes = (build_world_scenes(pair, worlds) if is_drawn else None) or ()
    pair.figures += compare_model_figures(*worlds, scenes)
    if pair.drawings.images and scenes:
        pair.images += render_worlds(*scenes)


def _may_be_visible(difference: Difference) -> bool:
    """Return whether images can show a difference."""
    path = to_path_pattern(f"{difference.name} {difference.property}".strip())
    return _INVISIBLE_TAGS.isdisjoint(path)


def world_contents(version: Version, path: str) -> Phrase | None:
    """Return the models of a world or the links and joints of a model; None if empty.

    Plugins and sensors are also listed.
    """
    elements = _read_elements(version.file(path))
    parts = [part for element in elements for part in summarize_element(element)]
    if _is_model(elements):
        parts += [part for element in elements for part in summarize_shapes_and_mass(element)]
    return joined(parts) if parts else None


def read_world_models(version: Version, path: str) -> list[str]:
    """Return the models and the addresses of the included models of a world; none if it cannot be read."""
    try:
        worlds = [element for element in _read_elements(version.file(path)) if element.tag == "world"]
    except (LinkwrightError, OSError, ValueError, RecursionError):
        return []
    return [name for tag in ("model", "include") for name in sorted(_find_names(worlds, tag))]


def is_model(version: Version, path: str) -> bool:
    """Return whether an SDF file has models and no world; False if it cannot be read."""
    try:
        return _is_model(_read_elements(version.file(path)))
    except (LinkwrightError, OSError, ValueError, RecursionError):
        return False


def _is_model(elements: Sequence[Element]) -> bool:
    return {"model"} == {element.tag for element in elements} & {"model", "world"}


@dataclass(frozen=True)
class _WorldChange:
    """A difference between two worlds, and the reason why it is breaking.

    Attributes:
        difference: the difference.
        reason: why it is breaking; None if it is not.
        text: the sentence, if it is known; else None.
    """

    difference: Difference
    reason: Phrase | None
    text: Phrase | None = None

    @property
    def path(self) -> str:
        """The names of the elements and of the value that differ."""
        return _join_path(self.difference)

    @property
    def kind(self) -> Hashable:
        """A key that is equal for equal changes to several elements."""
        difference = self.difference
        content = "" if difference.element is None else format_own_content(difference.element)
        if difference.element is not None and (is_added(difference) or is_removed(difference)):
            content = join_contents(difference.element)
        values = str(difference.format_values()) if isinstance(difference, InertialDifference) else ""
        reason = None if self.reason is None else str(self.reason)
        return difference.kind, difference.old, difference.new, content, values, reason

    @property
    def is_renamed(self) -> bool:
        """Whether the change is a new name."""
        return find_old_path(self.difference, self.path) is not None

    def location(self, pair: FilePair) -> Location | None:
        """Return the location in the new world, or in the old world for a removed element."""
        is_old = self.difference.new_place is None or (
            is_removed(self.difference) and self.difference.old_place is not None
        )
        location = self.difference.old_place if is_old else self.difference.new_place
        return None if location is None else pair.location(location.span, is_old=is_old)


def _group_equal_changes(changes: Sequence[_WorldChange]) -> Iterator[list[_WorldChange]]:
    """Yield groups of changes that are equal except for the names of the elements."""
    groups: dict[Hashable, list[_WorldChange]] = {}
    for number, change in enumerate(changes):
        is_alone = change.reason is not None or change.is_renamed or change.text is not None
        groups.setdefault(number if is_alone else (to_path_pattern(change.path), change.kind), []).append(change)
    yield from groups.values()


def _report_separately(pair: FilePair, changes: Sequence[_WorldChange]) -> None:
    """Report changes. Equal changes whose paths differ in one word are reported as one."""
    merged = MergedPaths()
    first_changes: list[_WorldChange] = []
    for change in changes:
        is_alone = change.is_renamed or change.text is not None
        if merged.add(change.path, id(change) if is_alone else change.kind) == len(first_changes):
            first_changes.append(change)
    for path, change in zip(merged.paths, first_changes, strict=True):
        text = change.text or _describe_difference(change.difference, path)
        pair.add(text, change.location(pair), change.reason)


def _read_elements(file: Path) -> list[Element]:
    if is_template(file.name):
        return read_template(str(file))
    document, _ = parse_as_gazebo(read_bytes(file), str(file))
    return list(document.root.elements())


def _describe_difference(difference: Difference, name: str) -> Phrase:
    """Return a difference in one line.

    Args:
        difference: the difference between both versions.
        name: the path of the element, with the names of other elements with the same difference.
    """
    old_path = find_old_path(difference, name)
    if old_path is not None:
        return phrase("{element} renamed to '{new}'", element=old_path, new=difference.new or "")
    if isinstance(difference, PluginReplacement):
        return phrase("{entry}: {change}", entry=name, change=difference.text)
    if isinstance(difference, InertialDifference):
        return phrase("{element}: {values}", element=name, values=difference.format_values())
    default = find_default(f"{difference.name} {difference.property}".strip())
    if default is not None and difference.element is not None and is_added(difference) != is_removed(difference):
        value = difference.element.text().strip()
        if is_added(difference):
            return phrase("{element}: {default} (default) -> {new}", element=name, default=default, new=value)
        return phrase("{element}: {old} -> {default} (default)", element=name, old=value, default=default)
    if is_added(difference):
        if difference.element is not None:
            return format_added_element(name, difference.element)
        return phrase("{element} added", element=f"{name} {difference.new or ''}".strip())
    if not is_removed(difference):
        empty = phrase("(empty)")
        old, new = differing_excerpts(difference.old or "", difference.new or "")
        text = phrase("{element}: {old} -> {new}", element=name, old=old or empty, new=new or empty)
        poses = parse_numbers(difference.old), parse_numbers(difference.new)
        is_pose = name.endswith(_POSE) and list(map(len, poses)) == [POSE_LENGTH, POSE_LENGTH]
        return add_pose_motion(text, *poses) if is_pose else text
    content = difference.old if difference.element is None else format_own_content(difference.element)
    text = phrase("{element} removed", element=f"{name} {content or ''}".strip())
    contents = None if difference.element is None else format_contents(difference.element)
    return text if contents is None else phrase("{change}: {contents}", change=text, contents=contents)


def _find_breaking_reason(difference: Difference, added: frozenset[str], elements: Sequence[Element]) -> Phrase | None:
    """Return the reason why a difference breaks users of the world; None if it does not.

    Args:
        difference: the difference between both versions.
        added: the topics that the new version adds.
        elements: the elements of the new version.
    """
    path = f"{difference.name} {difference.property}".strip()
    if PARAMETERS.fullmatch(path):
        return find_parameters_reason(difference.old or "", difference.new or "")
    is_macro = difference.element is not None and difference.element.tag == "macro"
    if (
        is_macro
        or _TEMPLATE_VALUE.fullmatch(difference.old or "")
        or _SET_VARIABLE.fullmatch(path)
        or may_be_equal(difference.old, difference.new)
        or is_same_sensor_topic(difference)
    ):
        return None
    named = None if _is_unused_decoration(difference, elements) else _find_lost_name(difference, path)
    if named is not None and not (named[0] == "include" and "/" in named[1]):
        return _make_name_reason(*named)
    if _INCLUDED_NAME.fullmatch(path) and difference.old:
        return _make_name_reason("include", difference.old)
    if isinstance(difference, PluginReplacement) or (is_removed(difference) and difference.element is not None):
        reason = find_missing_topics_reason(difference, added)
        if reason is not None:
            return reason
    limit = _JOINT_LIMIT.search(path)
    if limit is not None and difference.old and difference.new:
        return find_written_reason(limit["name"], limit["side"], difference.old, difference.new)
    is_used = ("plugin " in difference.property or "sensor" in difference.property) and not is_still_offered(
        difference, added
    )
    reason = find_plugin_name_reason(difference) if is_used else None
    return reason or find_default_topic_reason(difference, elements)


def _is_unused_decoration(difference: Difference, elements: Sequence[Element]) -> bool:
    """Return whether a difference is a removed static model that only has visuals, and that the new version ignores.

    Args:
        difference: the difference between both versions.
        elements: the elements of the new version.
    """
    model = difference.element if is_removed(difference) else None
    if model is None or model.tag != "model" or not model.attributes.get("name"):
        return False
    parts = list(model.walk())
    is_static = any(part.text().strip() in ("1", "true") for part in model.elements("static"))
    if not is_static or any(part.tag in _USED_TAGS for part in parts):
        return False
    name = model.attributes["name"]
    words = (
        word
        for root in elements
        for element in root.walk()
        for word in (element.text().strip(), *element.attributes.values())
    )
    return not any(word.partition("::")[0] == name for word in words)


def _find_lost_name(difference: Difference, path: str) -> tuple[str, str] | None:
    """Return the tag and the old name of a removed or renamed element; None for other differences.

    A name can contain spaces.
    """
    old_path = find_old_path(difference, path)
    name = difference.old if old_path is not None else None
    if old_path is None and is_removed(difference):
        old_path = path
        name = None if difference.element is None else difference.element.attributes.get("name")
    if old_path is None:
        return None
    if name and old_path.endswith(f" {name}"):
        tag = old_path.removesuffix(name).split()[-1]
        return (tag, name) if tag in _NAMED_TAGS else None
    match = _NAMED_ELEMENT.fullmatch(old_path)
    element = difference.element
    if match is None or isinstance(difference, InertialDifference):
        return None  # in the path of an inertial, a link that is named "link" looks like a tag
    return None if element is not None and element.tag != match["tag"] else (match["tag"], match["name"])


def _make_name_reason(tag: str, name: str) -> Phrase:
    if tag == "world":
        return world_reason(name)
    if tag in ("link", "frame"):
        return phrase(
            "programs that look up the frame '{name}', and models that attach to it, do not find it", name=name
        )
    if tag == "sensor":
        return phrase("the topics of the sensor '{name}' are missing", name=name)
    return phrase("programs and models that use the name '{name}' do not find it", name=name)
