"""Find nodes that may publish the transform of a removed static transform publisher."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from functools import partial
from itertools import pairwise

from linkwright.review.caching import cached_in_review
from linkwright.review.launch_paths import find_launch_files, is_launch_file
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.included import IncludedActions, find_including_files
from linkwright.review.launches.outlines import CONDITION, Entry, LaunchOutline
from linkwright.review.launches.programs.sources import SourcePrograms, try_read_outline
from linkwright.review.launches.titles import TRANSFORM_PUBLISHERS, find_served_names
from linkwright.review.sources.broadcasters import find_new_broadcasters
from linkwright.review.texts.list_changes import split_command
from linkwright.review.versions import Version, Versions

_ANY_FRAME_PROGRAM = re.compile(r"robot_state_publisher/|state_publisher/|apriltag\w*/|aruco\w*/|mocap\w*/|vrpn\w*/")
"""Programs that publish the transforms of any frame."""
_STATE_PUBLISHER = re.compile(r"(robot_)?state_publisher/")
_ROBOT_PROGRAM = re.compile(r"(robot_|joint_)?state_publisher(_gui)?/")
"""Programs of a launch file with a robot, whose links have transforms."""
_LOCALIZATION_PROGRAM = re.compile(
    r"fake_localization/|(nav2_)?amcl/|slam_\w+/|gmapping/|hector_mapping/|cartographer_ros/|rtabmap_\w+/|"
    r"robot_localization/(ekf|ukf)|robot_pose_ekf/|\w*odometry\w*/"
)
"""Programs that publish the transform between the map, the odometry and the robot."""
_LOCALIZATION_FILE = re.compile(r"slam|nav|map|loc|odom|lio|ekf|fusion", re.IGNORECASE)
"""The paths of launch files that may start such programs."""
_LOCALIZATION_FRAME = re.compile(r"(.*/)?(map|odom|odom_combined|base|base_link|base_footprint|footprint)")
_INCLUDED_PACKAGE = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w.-]+)\)/")
_PARAMETER_FILE = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w.-]+)\)/(?P<path>[^$\s,\]]+\.ya?ml)")
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_LINK = re.compile(r"<link\s+name=[\"']([^\"']+)[\"']")
_SUBSTITUTION = re.compile(r"\$[{(][^{}()]*[)}]")
_FRAME_WORD = re.compile(r"[\w/.-]+")
_PARENT_FRAME = "--frame-id"
_SWITCH = re.compile(r"(publish|broadcast|enable)_(odom_|map_)?(tf|transform)")


def find_other_publisher(transform: Entry, old: LaunchOutline, new: LaunchOutline, versions: Versions) -> Entry | None:
    """Return a node or include that newly may publish the transform of a removed publisher, or None.

    An added node may publish it if its program publishes static transforms, or if its parameters name both frames. A
    node that was there before may do so if its source newly broadcasts the frame, or if its parameters, which name both
    frames, newly turn the transform on. An included file of another repository may publish it if it starts a
    localization, or if it gets the name of the frame.

    Args:
        transform: the removed static transform publisher.
        old: the outline of the old file.
        new: the outline of the new file.
        versions: both versions, with the parameter files and the other launch files.
    """
    frames = {frame.strip("/") for frame in _find_parent_and_child(transform, old)}
    if len(frames) != 2 or not transform.name.startswith(TRANSFORM_PUBLISHERS):
        return None
    are_localized = all(map(_LOCALIZATION_FRAME.fullmatch, frames))
    old_names = {entry.name for entry in old.entries if entry.kind in ("node", "include")}
    list_old_switches = partial(_list_switches, outline=old, version=versions.old)
    sources = [SourcePrograms(versions.new, path) for path in find_new_broadcasters(versions, frames)]
    for entry in new.entries:
        if entry.kind not in ("node", "include"):
            continue
        if evaluate_condition(new.resolve(entry.settings.get(CONDITION, ""))) is False:
            continue
        if entry.kind == "node" and any(source.runs(entry.name) for source in sources):
            return entry
        if entry.name in old_names:
            before = {name for node in old.entries if node.name == entry.name for name in list_old_switches(node)}
            is_on = entry.kind == "node" and not before.issuperset(_list_switches(entry, new, versions.new))
            if is_on and frames <= set(_find_parameter_words(entry, new, versions.new)):
                return entry
            continue
        if entry.kind == "include":
            is_localization = are_localized and _LOCALIZATION_FILE.search(entry.name) is not None
            if (is_localization or not frames.isdisjoint(entry.settings.values())) and _is_absent(entry, versions.new):
                return entry
            continue
        if entry.name.startswith(TRANSFORM_PUBLISHERS):
            continue
        is_localized = _LOCALIZATION_PROGRAM.match(entry.name) and are_localized
        if (
            _ANY_FRAME_PROGRAM.match(entry.name)
            or is_localized
            or frames <= set(_find_parameter_words(entry, new, versions.new))
        ):
            return entry
    return _find_added_robot(frames, versions)


def _list_switches(node: Entry, outline: LaunchOutline, version: Version) -> set[str]:
    """Return the parameters of a node that turn on a transform, such as ``publish_tf``."""
    words = list(_find_parameter_words(node, outline, version))
    settings = ((name.removeprefix("parameter "), outline.resolve(value)) for name, value in node.settings.items())
    pairs = (*settings, *pairwise(words))
    return {name for name, value in pairs if _SWITCH.fullmatch(name) and value.lower() == "true"}


def _is_absent(include: Entry, version: Version) -> bool:
    """Return whether an include names a file of a package that the repository does not have."""
    match = _INCLUDED_PACKAGE.match(include.name)
    return match is not None and version.share_of(match["package"], version.root) is None


def has_robot_with_frame(transform: Entry, old: LaunchOutline, new: IncludedActions, version: Version) -> bool:
    """Return whether a robot that is started together with a launch file has the frame of a removed publisher.

    A description of the repository must have the frame as a link. Then the removed publisher gave it a second parent.

    Args:
        transform: the removed static transform publisher.
        old: the outline of the old file.
        new: the actions of the new file with those of its included files.
        version: the new version, with the files that include the launch file.
    """
    frames = _find_parent_and_child(transform, old) if transform.name.startswith(TRANSFORM_PUBLISHERS) else []
    return len(frames) == 2 and starts_robot_with_link(frames[1], new, version)


def starts_robot_with_link(frame: str, new: IncludedActions, version: Version) -> bool:
    """Return whether a robot of the repository that is started together with a launch file has a frame as a link.

    Args:
        frame: the frame.
        new: the actions of the file with those of its included files.
        version: the version, with the files that include the launch file.
    """
    if frame.strip("/") not in _list_links(version):
        return False
    including = (actions for actions, _ in find_including_files(version, new.path))
    return any(actions.find_node(_ROBOT_PROGRAM) is not None for actions in (new, *including))


def gets_transform(
    program: str, old_frame: str, new_frame: str, old: IncludedActions, new: IncludedActions, version: Version
) -> bool:
    """Return whether the data of a node gets a frame with a transform instead of one that never had any.

    A launch file that starts a robot with the old frame counts, unless it starts the node itself and thus replaces this
    launch file.

    Args:
        program: the package and the executable of the node.
        old_frame: the frame of the old version.
        new_frame: the frame of the new version.
        old: the actions of the old file with those of its included files.
        new: the actions of the new file with those of its included files.
        version: the old version, with its descriptions and launch files.
    """
    frames = _list_transform_frames(old), _list_transform_frames(new)
    names = [frame.strip("/") for frame in (old_frame, new_frame)]
    entries = [entry for outline in (old.outline, *old.included_outlines) for entry in outline.entries]
    if names[0] in frames[0] or names[1] not in frames[0] & frames[1]:
        return False
    if any(_ANY_FRAME_PROGRAM.match(entry.name) or _is_absent(entry, version) for entry in entries):
        return False
    if names[0] not in _list_description_words(version):
        return True
    for path in find_launch_files(version):
        programs = [entry.name for entry in _read_nodes(version, path)]
        if program not in programs and any(map(_ROBOT_PROGRAM.match, programs)):
            return False
    return True


def _list_transform_frames(actions: IncludedActions) -> set[str]:
    """Return the frames of the static transforms of a launch file and its included files."""
    return {
        frame.strip("/")
        for outline in (actions.outline, *actions.included_outlines)
        for entry in outline.entries
        if entry.name.startswith(TRANSFORM_PUBLISHERS)
        for frame in _find_parent_and_child(entry, outline)
    }


def _find_added_robot(frames: Collection[str], versions: Versions) -> Entry | None:
    """Return a node that another launch file newly starts and that publishes the frames of a robot, or None.

    A description of the repository must have the frames.
    """
    for file in versions.changed_files:
        if file.new_path is None or not is_launch_file(file.new_path):
            continue
        names = {entry.name for entry in _read_nodes(versions.old, file.old_path)}
        added = [entry for entry in _read_nodes(versions.new, file.new_path) if entry.name not in names]
        publisher = next((entry for entry in added if _STATE_PUBLISHER.match(entry.name)), None)
        if publisher is not None and _list_description_words(versions.new).issuperset(frames):
            return publisher
    return None


@cached_in_review(maxsize=4)
def _list_links(version: Version) -> frozenset[str]:
    """Return the names of the links in the descriptions of a version, without prefixes from arguments."""
    texts = (_COMMENT.sub("", version.text(path)) for path in version.paths((".urdf", ".xacro")))
    return frozenset(_SUBSTITUTION.sub("", name) for text in texts for name in _LINK.findall(text))


def _read_nodes(version: Version, path: str | None) -> list[Entry]:
    """Return the nodes of a launch file; none if it cannot be read."""
    outline = None if path is None else try_read_outline(version, path)
    return [] if outline is None else [entry for entry in outline.entries if entry.kind == "node"]


@cached_in_review(maxsize=4)
def _list_description_words(version: Version) -> frozenset[str]:
    """Return the words in the descriptions of a version."""
    return frozenset(
        word for path in version.paths((".urdf", ".xacro")) for word in _FRAME_WORD.findall(version.text(path))
    )


def _find_parent_and_child(transform: Entry, outline: LaunchOutline) -> list[str]:
    """Return the parent and child frames of a static transform; empty if unknown."""
    text = outline.resolve(transform.settings.get("arguments", ""))
    names = find_served_names(Entry(transform.kind, transform.name, {"arguments": text}, transform.span))
    if not names:
        return []
    words = split_command(text)
    if _PARENT_FRAME in words[:-1]:
        return [words[words.index(_PARENT_FRAME) + 1], names[0]]
    index = len(words) - 1 - words[::-1].index(names[0])
    return [words[index - 1], names[0]]


def _find_parameter_words(node: Entry, outline: LaunchOutline, version: Version) -> Iterator[str]:
    """Yield the words in the parameters of a node.

    This includes the parameter files of the repository that the node loads.
    """
    for setting, value in node.settings.items():
        if not setting.startswith("parameter"):
            continue
        text = outline.resolve(value)
        yield from (word.strip("/") for word in _FRAME_WORD.findall(text))
        for match in _PARAMETER_FILE.finditer(text):
            share = version.share_of(match["package"], version.root)
            file = None if share is None or ".." in match["path"] else share / match["path"]
            path = None if file is None or not file.is_file() else version.relative(file)
            if path is not None:
                yield from (word.strip("/") for word in _FRAME_WORD.findall(version.text(path)))
