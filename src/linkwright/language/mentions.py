"""Mentions of links and joints in YAML files, RViz configurations and launch files.

These formats do not define the meaning of a text. A mention is certain only where a key, an option or the format shows
that it means a link or a joint.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from linkwright.language.definitions import NameKind
from linkwright.loading.deferred import lazy_pattern
from linkwright.xmltree.tokens import Kind, tokens

FILE_SUFFIXES = (".yaml", ".yml", ".rviz", ".launch.py", ".launch.xml", ".launch", ".py")
"""The suffixes of the files that may mention names."""

_MAX_TEXT_LENGTH = 1_000_000
"""The maximum length in characters. Longer files are data, not configuration."""
_FRAME_KEY = lazy_pattern(r"(?i)(^|[ _/])(frame|frame_id|link|base|tip|root|ee_link|footprint|body)s?(_name)?s?$")
_JOINT_KEY = lazy_pattern(r"(?i)((^|[ _])(joint|wheel)(_?names?)?s?$)|(^|_)joint_names?$|^dof_names$")
_INTERFACE_NAMES = frozenset(("position", "velocity", "effort", "acceleration"))
"""The interfaces of a joint: they follow the joint's name and a slash."""
_JOINT_MAPPINGS = frozenset(
    (
        "joint_limits",
        "gains",
        "pid_gains",
        "constraints",
        "initial_positions",
        "joints",
        "zeros",
        "dependent_joints",
        "default_acceleration",
    )
)
"""Keys whose content is a mapping from joints."""
_LINK_MAPPINGS = frozenset(("Links", "Frames", "Tree"))
"""Keys of RViz displays whose content is a mapping from links or frames."""
_TRANSFORM = "static_transform_publisher"
_POSE_ARGUMENT_COUNT = 6
"""The numbers of a pose, in front of the frames in the arguments of a static transform."""
_FRAME_OPTIONS = ("--frame-id", "--child-frame-id")


@dataclass(frozen=True, slots=True)
class Mention:
    """A text that is, or may be, the name of a link or joint.

    Attributes:
        name: the text.
        file: the file that contains it.
        start: the offset of the first character.
        kinds: the kinds of names that the context allows, or empty if they are unknown.
    """

    name: str
    file: Path
    start: int
    kinds: tuple[NameKind, ...] = ()

    @property
    def end(self) -> int:
        """The offset after the last character."""
        return self.start + len(self.name)


def mentions_in(text: str, file: Path, names: frozenset[str]) -> Iterator[Mention]:
    """Yield the mentions of some names as a whole value, key, string or word.

    Args:
        text: the text of the file. A text that cannot be parsed has no mentions.
        file: the file, whose name determines its format.
        names: the names of links and joints to search.
    """
    if len(text) > _MAX_TEXT_LENGTH or not any(name in text for name in names):
        return
    if file.name.endswith((".yaml", ".yml", ".rviz")):
        yield from _mentions_in_yaml(text, file, names)
    elif file.name.endswith(".py"):
        yield from _mentions_in_python(text, file, names)
    elif file.name.endswith((".sdf", ".world")):
        yield from _mentions_in_sdf(text, file, names)
    else:
        yield from _mentions_in_launch_xml(text, file, names)


def _mentions_in_yaml(text: str, file: Path, names: frozenset[str]) -> Iterator[Mention]:
    try:
        documents = [*yaml.compose_all(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))]
    except (yaml.YAMLError, RecursionError):
        return
    pending: list[tuple[Any, tuple[str, ...], bool]] = [(document, (), False) for document in reversed(documents)]
    while pending:
        node, keys, is_key = pending.pop()
        if isinstance(node, yaml.MappingNode):
            for key, value in reversed(node.value):
                own_key = key.value if isinstance(key, yaml.ScalarNode) else ""
                pending.append((value, (*keys, own_key), False))
                pending.append((key, keys, True))
        elif isinstance(node, yaml.SequenceNode):
            pending += [(item, keys, False) for item in reversed(node.value)]
        elif isinstance(node, yaml.ScalarNode) and node.value.removeprefix("/") in names:
            name = node.value.removeprefix("/")  # In tf 1, frame names began with a slash.
            start = node.start_mark.index + (1 if node.style in ("'", '"') else 0) + len(node.value) - len(name)
            if text[start : start + len(name)] == name:
                yield Mention(name, file, start, _kinds_of_path(keys, is_key=is_key))
        elif isinstance(node, yaml.ScalarNode) and "/" in node.value:
            yield from _mentions_in_path(node.value, text, node.start_mark.index, file, names)


def _mentions_in_path(value: str, text: str, begin: int, file: Path, names: frozenset[str]) -> Iterator[Mention]:
    """Yield the names in a value with slashes, such as ``left_wheel_joint/velocity``."""
    parts = value.split("/")
    start = text.find(value, begin, begin + len(value) + 2)
    for index, part in enumerate(parts):
        if part in names and start >= 0:
            is_joint = index == 0 and len(parts) == 2 and parts[1] in _INTERFACE_NAMES
            yield Mention(part, file, start, (NameKind.JOINT,) if is_joint else ())
        start += len(part) + 1


def _kinds_of_path(keys: Sequence[str], *, is_key: bool) -> tuple[NameKind, ...]:
    last = keys[-1] if keys else ""
    if is_key:
        if not _LINK_MAPPINGS.isdisjoint(keys):
            return (NameKind.LINK,)
        return (NameKind.JOINT,) if last in _JOINT_MAPPINGS else ()
    return kinds_of_key(last)


def kinds_of_key(key: str) -> tuple[NameKind, ...]:
    """Return the kinds of names that the value of a key may contain."""
    if _JOINT_KEY.search(key):
        return (NameKind.JOINT,)
    return (NameKind.LINK,) if _FRAME_KEY.search(key) else ()


def _mentions_in_python(text: str, file: Path, names: frozenset[str]) -> Iterator[Mention]:
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    lines = text.splitlines()
    kinds = dict(_kinds_in_python(tree))
    for node in ast.walk(tree):
        if not isinstance(node, ast.Constant) or node.value not in names or not isinstance(node.value, str):
            continue
        column = len(lines[node.lineno - 1].encode()[: node.col_offset].decode(errors="replace"))
        start = starts[node.lineno - 1] + column + 1
        if (
            text[start : start + len(node.value)] == node.value
        ):  # This is a string with single quotation marks and no prefix.
            yield Mention(node.value, file, start, kinds.get(id(node), ()))


def _kinds_in_python(tree: ast.AST) -> Iterator[tuple[int, tuple[NameKind, ...]]]:
    """Yield the `id` and kinds of each string that is a parameter value or a frame option."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Dict):
            for key, value in zip(node.keys, node.values, strict=True):
                if isinstance(key, ast.Constant) and isinstance(key.value, str):
                    for item in value.elts if isinstance(value, (ast.List, ast.Tuple)) else [value]:
                        yield id(item), kinds_of_key(key.value)
        elif isinstance(node, ast.keyword) and node.arg:
            yield id(node.value), kinds_of_key(node.arg)
        elif isinstance(node, ast.Call):
            keywords = {keyword.arg: keyword.value for keyword in node.keywords}
            program, words = keywords.get("executable"), keywords.get("arguments")
            if isinstance(program, ast.Constant) and program.value == _TRANSFORM and isinstance(words, ast.List):
                for item in words.elts[_POSE_ARGUMENT_COUNT:] if len(words.elts) > _POSE_ARGUMENT_COUNT else ():
                    yield id(item), (NameKind.LINK,)
        elif isinstance(node, (ast.List, ast.Tuple)):
            for option, item in zip(node.elts, node.elts[1:], strict=False):
                if isinstance(option, ast.Constant) and option.value in _FRAME_OPTIONS:
                    yield id(item), (NameKind.LINK,)


def _mentions_in_sdf(text: str, file: Path, names: frozenset[str]) -> Iterator[Mention]:
    """Yield the mentions in a model, which are never certain.

    A model has its own names, but the frames of its sensors are often frames of a robot.
    """
    words = "|".join(map(re.escape, sorted(names, key=len, reverse=True)))
    for match in re.finditer(rf"(?<=[>\"'])({words})(?=[<\"'])", text):
        yield Mention(match[1], file, match.start(1))


def _mentions_in_launch_xml(text: str, file: Path, names: frozenset[str]) -> Iterator[Mention]:
    words = re.compile(rf"(?<![\w/.-])(?:{'|'.join(map(re.escape, sorted(names, key=len, reverse=True)))})(?![\w/.-])")
    for token in tokens(text):
        if token.kind is not Kind.START:
            continue
        attributes = {attribute.name: attribute for attribute in token.attributes() if attribute.value}
        key = attributes["name"].value if "name" in attributes else ""
        program = next((attributes[name].value for name in ("exec", "type") if name in attributes), "")
        for attribute in attributes.values():
            value = attribute.value or ""
            for match in words.finditer(value):
                is_whole = match[0] == value and attribute.name in ("value", "default")
                preceding_words = value[: match.start()].split() if attribute.name == "args" else []
                kinds = kinds_of_key(key or "") if is_whole else ()
                is_frame = preceding_words[-1:] and preceding_words[-1] in _FRAME_OPTIONS
                if is_frame or (
                    program == _TRANSFORM
                    and len(preceding_words) >= _POSE_ARGUMENT_COUNT
                    and preceding_words[0][:1] != "-"
                ):
                    kinds = (NameKind.LINK,)
                yield Mention(match[0], file, attribute.value_start + match.start(), kinds)
