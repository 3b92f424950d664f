"""Find sources, launch files, parameter files and configurations that still name a lost frame or joint."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.manifest import package_name
from linkwright.review.breaking import frame_reason, frames_reason, joint_name_reason, transform_reason
from linkwright.review.changes import Change, Effect, Location, Subject, SubjectKind
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.yaml_values import read_yaml_values
from linkwright.review.launches.outlines import PARAMETER, without_condition
from linkwright.review.launches.programs.script_options import LAUNCH_SUFFIXES
from linkwright.review.launches.programs.sources import list_nodes, try_read_outline
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX, NameKind
from linkwright.review.sources.reading import read_source_names
from linkwright.review.texts.list_changes import list_items
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_SOURCE_SUFFIXES = (*CPP_SUFFIXES, PYTHON_SUFFIX)
_SETTINGS_SUFFIXES = (".yaml", ".yml")
_RVIZ_SUFFIX = ".rviz"
_SEMANTIC_SUFFIX = ".srdf"
_DESCRIPTION_SUFFIXES = (".urdf", ".xacro")
_ROBOT_SUFFIXES = (".urdf", ".xacro", ".sdf", ".world", ".mjcf", ".xml")
_PACKAGE_USERS = (*LAUNCH_SUFFIXES, "package.xml", *_SETTINGS_SUFFIXES, PYTHON_SUFFIX)
_FRAME_KEY = re.compile(r"(?:.*_)?frame(?:_id|_name)?", re.IGNORECASE)
_OFFERING_KEY = re.compile(
    r"(?:base|odom|odometry|map|world|child|root|parent|base_link|base_footprint|robot|publish\w*|broadcast\w*)"
    r"_frame(?:_id|_name)?",
    re.IGNORECASE,
)
"""The parameters with frames that a node may publish itself, so that they are not lost."""
_JOINT_KEY = re.compile(r"joints?|joint_names?|\w*wheel_names|\w+_joints?|\w+_joint_names?")
_RVIZ_FRAME = re.compile(
    r"^[ \t]*(?:Fixed|Target|Reference) Frame:[ \t]*[\"']?(?P<name>[^\s\"'#]+)[\"']?[ \t]*$", re.MULTILINE
)
_SEMANTIC_JOINT = re.compile(r"<(?:joint|passive_joint)\b[^>]*\bname\s*=\s*[\"'](?P<name>[^\"']+)[\"']")
_SEMANTIC_LINK = re.compile(r"\b(?:base_link|tip_link|child_link|parent_link)\s*=\s*[\"'](?P<name>[^\"']+)[\"']")
"""The attributes of chains, end effectors and virtual joints. Pairs of links without a collision do no harm."""
_ROBOT_REFERENCE = re.compile(r"<gazebo\b[^>]*\breference\s*=\s*[\"'](?P<name>[^\"']+)[\"']")
_ROBOT_LINK = re.compile(r"<(?:parent|child)\b[^>]*\blink\s*=\s*[\"'](?P<name>[^\"']+)[\"']")
_XML_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_TRANSFORM_PUBLISHERS = ("static_transform_publisher", "tf_prefix")
_DEFINITIONS = {
    True: re.compile(r"<(?:link|frame|body)\b[^>]*\bname\s*=\s*[\"'](?P<name>[^\"']+)[\"']"),
    False: re.compile(r"<joint\b(?=[^>]*\btype\s*=)[^>]*\bname\s*=\s*[\"'](?P<name>[^\"']+)[\"']"),
}
"""The elements that define frames (True) and joints (False)."""
_MACRO_CALL = re.compile(
    r"<(?:xacro|[a-z]\w*):(?!macro|property|arg\b|include|if\b|unless\b|insert_block\b|call\b|element\b|attribute\b)"
    r"(?P<macro>[\w.-]+)\b(?P<values>[^>]*)>"
)
_ATTRIBUTE_VALUE = re.compile(r"=\s*[\"']([^\"']+)[\"']")
_SUBSTITUTION = re.compile(r"\$\{[^}]*\}|\$\([^)]*\)")
_BROADCAST = re.compile(r"\bsendTransform\b|TransformBroadcaster\b")
_COMMON_FRAMES = frozenset({"earth", "map", "odom", "world"})
"""The frames that localization and simulations publish, too."""
_QUOTED_NAME = re.compile(r"'([^']*)'")
_PLAIN_NAME = re.compile(r"[\w/.-]{2,}")


@dataclass(frozen=True)
class RobotName:
    """A frame or joint of a robot, such as one that the new version of a file no longer has.

    Args:
        name: the name.
        path: the path of the file.
        is_frame: whether it is a frame, not a joint.
    """

    name: str
    path: str
    is_frame: bool

    def make_change(self, path: str, line: int, column: int, reason: Phrase) -> tuple[str, Change]:
        """Return the change about a file that still names it."""
        values = {"name": self.name, "file": self.path}
        text = phrase("names the joint '{name}', which '{file}' no longer has", **values)
        if self.is_frame:
            text = phrase("names the frame '{name}', which '{file}' no longer has", **values)
        return path, Change(text, Effect.BREAKING, reason, Location(path, line, column))


def find_left_robot_names(versions: Versions, subjects: Sequence[Subject]) -> Iterator[tuple[str, Change]]:
    """Yield the files that still name a lost frame or joint, each with a change.

    A name that another file of the new version may still define is left out, and so are files of packages that do not
    mention the package with the loss. A file that names what several files have lost has one change.

    Args:
        versions: both versions of the repository.
        subjects: the compared files, whose breaking changes tell what is lost.
    """
    lost = list(dict.fromkeys(list_lost_names(subjects)))
    files = RobotFiles(versions.new)
    lost = [item for item in lost if not files.may_define(item)] if lost else []
    found = {(item.name, item.is_frame, item.path) for item in lost}
    for item in lost:
        for path, change in files.find_users(item):
            if _gives_frame(versions, path, change, item):
                continue
            user = (item.name, item.is_frame, path)
            if user not in found and files.are_related(path, item.path):
                found.add(user)
                yield path, change


def _gives_frame(versions: Versions, path: str, change: Change, lost: RobotName) -> bool:
    """Return whether a launch file newly passes a frame to the package whose source had it as a constant.

    The frame is then a parameter of the program, and the launch file still defines it.
    """
    folder = versions.new.package_of(lost.path)
    if folder is None or not lost.path.endswith(_SOURCE_SUFFIXES) or not path.endswith(LAUNCH_SUFFIXES):
        return False
    outline, package = try_read_outline(versions.new, path), package_name(versions.new.file(folder))
    if outline is None or change.location is None or lost.name in versions.old.text(path):
        return False
    line = change.location.line
    return any(node.span.line == line and node.name.startswith(f"{package}/") for node in list_nodes(outline))


def list_lost_names(subjects: Sequence[Subject]) -> Iterator[RobotName]:
    """Yield the frames and moving joints that files lost with all argument sets."""
    templates = {
        frame_reason("").template: True,
        frames_reason(["", ""]).template: True,
        transform_reason("").template: True,
        joint_name_reason("").template: False,
    }
    for subject in subjects:
        for change in subject.changes:
            if change.reason is None or change.reason.template not in templates or change.cases:
                continue
            for word in (*list_names_of_reason(change.reason), *_list_other_names(change)):
                is_lost = _PLAIN_NAME.fullmatch(word) and word.strip("/") not in _COMMON_FRAMES
                if is_lost and subject.kind is not SubjectKind.PART:
                    yield RobotName(word.strip("/"), subject.path, templates[change.reason.template])


def list_names_of_reason(reason: Phrase) -> list[str]:
    """Return the names that a reason gives as ``name`` or, each in quotation marks, as ``names``."""
    arguments = reason.arguments
    return [str(arguments["name"])] if "name" in arguments else _QUOTED_NAME.findall(str(arguments["names"]))


def _list_other_names(change: Change) -> list[str]:
    """Return the old names of other links or joints that change in the same way."""
    return [name.partition(" -> ")[0].strip("'") for name in change.other_names]


class RobotFiles:
    """The files of a version that may define or name frames and joints, without tests.

    Args:
        version: the version of the repository.
    """

    def __init__(self, version: Version) -> None:
        self._version = version

    @cached_property
    def _texts(self) -> dict[str, str]:
        suffixes = (*_SOURCE_SUFFIXES, *_SETTINGS_SUFFIXES, _RVIZ_SUFFIX, _SEMANTIC_SUFFIX, *_ROBOT_SUFFIXES)
        paths = self._version.paths((*suffixes, *LAUNCH_SUFFIXES))
        return {path: self._version.text(path) for path in paths if _is_searched(path)}

    def may_define(self, lost: RobotName) -> bool:
        """Return whether another file may define a lost frame or joint."""
        for path, text in self._texts.items():
            is_robot = path.endswith(_ROBOT_SUFFIXES)
            if is_robot and any(self._may_pass(values) for values in _find_definitions(text, lost)):
                return True
            if not lost.is_frame or lost.name not in text:
                continue
            if path.endswith(_SOURCE_SUFFIXES) and not is_launch_file_name(PurePosixPath(path).name):
                names = read_source_names(self._version.file(path)).of_kind(NameKind.FRAME)
                may_send = _BROADCAST.search(text) and re.search(rf"[\"']/?{re.escape(lost.name)}[\"']", text)
                if may_send or any(item.name.strip("/") == lost.name for item in names):
                    return True
            elif is_launch_file_name(PurePosixPath(path).name) or path.endswith(LAUNCH_SUFFIXES):
                if any(word in text for word in _TRANSFORM_PUBLISHERS):
                    return True
            elif path.endswith(_SETTINGS_SUFFIXES) and any(
                _OFFERING_KEY.fullmatch(key) for key, *_ in _find_settings(text, lost.name)
            ):
                return True
        return False

    def may_make(self, name: str) -> bool:
        """Return whether a macro of another repository gets a value with which a name begins; it may make the name."""
        return any(name.startswith(value) for value in self._names_of_unknown_macros)

    def is_in_robot(self, name: str) -> bool:
        """Return whether a robot or world contains a name in any place."""
        return any(name in text for path, text in self._texts.items() if path.endswith(_ROBOT_SUFFIXES))

    def _may_pass(self, values: Sequence[str]) -> bool:
        """Return whether the files contain all values of substitutions, of which some may be empty."""
        texts = [text for path, text in self._texts.items() if not path.endswith(_SETTINGS_SUFFIXES)]
        return all(any(f'"{value}"' in text or f"'{value}'" in text for text in texts) for value in values if value)

    def find_users(self, lost: RobotName) -> Iterator[tuple[str, Change]]:
        """Yield the files that name a lost frame or joint, each with a change."""
        for path, text in self._texts.items():
            if lost.name not in text:
                continue
            if path.endswith(_SETTINGS_SUFFIXES) and not path.endswith(LAUNCH_SUFFIXES):
                yield from self._find_in_settings(path, text, lost)
            elif path.endswith(LAUNCH_SUFFIXES) or is_launch_file_name(PurePosixPath(path).name):
                yield from self._find_in_launch_file(path, lost)
            elif path.endswith(_SOURCE_SUFFIXES) and lost.is_frame:
                for item in read_source_names(self._version.file(path)).of_kind(NameKind.FRAME_LOOKUP):
                    if item.name.strip("/") == lost.name:
                        yield lost.make_change(path, item.span.line, item.span.column, phrase("the lookup fails"))
            elif path.endswith(_RVIZ_SUFFIX) and lost.is_frame:
                yield from _find_in_text(path, text, _RVIZ_FRAME, lost)
            elif path.endswith(_SEMANTIC_SUFFIX):
                pattern = _SEMANTIC_LINK if lost.is_frame else _SEMANTIC_JOINT
                yield from _find_in_text(path, _XML_COMMENT.sub(_blank, text), pattern, lost)
            elif path.endswith(_DESCRIPTION_SUFFIXES) and lost.is_frame:
                yield from self._find_in_description(path, _XML_COMMENT.sub(_blank, text), lost)

    def _find_in_description(self, path: str, text: str, lost: RobotName) -> Iterator[tuple[str, Change]]:
        """Yield the changes about elements for a lost link, also under conditions that no compared robot fulfills.

        A file that calls a macro of another repository is not searched, because the macro may make the link.
        """
        if self._calls_unknown_macro(text) or self.may_make(lost.name):
            return
        yield from _find_in_text(path, text, _ROBOT_LINK, lost, phrase("the link of the joint does not exist"))
        joint = replace(lost, is_frame=False)
        robots = (other for name, other in self._texts.items() if name.endswith(_ROBOT_SUFFIXES))
        if not any(True for other in robots for _ in _find_definitions(other, joint)):
            yield from _find_in_text(path, text, _ROBOT_REFERENCE, lost, phrase("Gazebo ignores the element"))

    def _calls_unknown_macro(self, text: str) -> bool:
        return any(match["macro"] not in self._version.macros for match in _MACRO_CALL.finditer(text))

    @cached_property
    def _names_of_unknown_macros(self) -> frozenset[str]:
        """The values that descriptions pass to macros of other repositories, which may prefix names with them."""
        return frozenset(
            value
            for path, text in self._texts.items()
            if path.endswith(_DESCRIPTION_SUFFIXES)
            for match in _MACRO_CALL.finditer(_XML_COMMENT.sub("", text))
            if match["macro"] not in self._version.macros
            for value in _ATTRIBUTE_VALUE.findall(match["values"])
            if _PLAIN_NAME.fullmatch(value)
        )

    def _find_in_settings(self, path: str, text: str, lost: RobotName) -> Iterator[tuple[str, Change]]:
        pattern = _FRAME_KEY if lost.is_frame else _JOINT_KEY
        for key, line, column in _find_settings(text, lost.name):
            if pattern.fullmatch(key):
                yield lost.make_change(path, line, column, _make_reason(lost))

    def _find_in_launch_file(self, path: str, lost: RobotName) -> Iterator[tuple[str, Change]]:
        outline = try_read_outline(self._version, path) if lost.is_frame else None
        for entry in list_nodes(outline) if outline is not None else ():
            for name, value in entry.settings.items():
                key = without_condition(name).removeprefix(PARAMETER)
                is_own = outline is not None and outline.resolve(value).strip("/\"'") == lost.name
                if name.startswith(PARAMETER) and is_own and _FRAME_KEY.fullmatch(key.rpartition(".")[2]):
                    yield lost.make_change(path, entry.span.line, entry.span.column, _make_reason(lost))

    def are_related(self, path: str, other: str) -> bool:
        """Return whether a file is in the package of another one, or in a package that mentions it."""
        folder, other_folder = self._version.package_of(path), self._version.package_of(other)
        if folder is None or other_folder is None:
            return False
        name = package_name(self._version.file(other_folder)) or ""
        return folder == other_folder or (
            bool(name) and any(name in self._version.text(user) for user in self._version.paths(_PACKAGE_USERS, folder))
        )


def _find_definitions(text: str, lost: RobotName) -> Iterator[tuple[str, ...]]:
    """Yield the values of substitutions with which a robot or world defines a name; none for a plain definition."""
    text = _XML_COMMENT.sub("", text)
    for match in _DEFINITIONS[lost.is_frame].finditer(text):
        literals = _SUBSTITUTION.split(match["name"])
        values = re.fullmatch("(.*)".join(map(re.escape, literals)), lost.name)
        if values is not None:
            yield values.groups()
    pattern = re.compile(rf"=\s*[\"']/?{re.escape(lost.name)}[\"']")
    if any(pattern.search(match["values"]) for match in _MACRO_CALL.finditer(text)):
        yield ()


def _find_settings(text: str, name: str) -> Iterator[tuple[str, int, int]]:
    """Yield the keys of a YAML file whose value is a name or a list with it, each with its line and column."""
    if name not in text:
        return
    try:
        values = read_yaml_values(text)
    except UnreadableFileError:
        return
    for path, value in values.items():
        items = list_items(value.text) if value.is_list else [value.text]
        if any(item.strip("/\"'") == name for item in items):
            yield re.split(r"[.\[]", path.rstrip("]"))[-1], value.line, value.column


def _find_in_text(
    path: str, text: str, pattern: re.Pattern[str], lost: RobotName, reason: Phrase | None = None
) -> Iterator[tuple[str, Change]]:
    for match in pattern.finditer(text):
        if match["name"].strip("/") == lost.name:
            start = match.start("name")
            column = start - text.rfind("\n", 0, start)
            yield lost.make_change(path, text.count("\n", 0, start) + 1, column, reason or _make_reason(lost))


def _make_reason(lost: RobotName) -> Phrase:
    if lost.is_frame:
        return phrase("transforms of the frame '{name}' are not found", name=lost.name)
    return phrase("the joint '{name}' is not found", name=lost.name)


def _blank(match: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", match[0])


def _is_searched(path: str) -> bool:
    return TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)
