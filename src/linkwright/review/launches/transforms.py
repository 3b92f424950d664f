"""Find nodes that may publish the transform of a removed static transform publisher."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.outlines import CONDITION, Entry, LaunchOutline
from linkwright.review.launches.titles import TRANSFORM_PUBLISHERS, find_served_names
from linkwright.review.list_changes import list_items
from linkwright.review.versions import Version

_ANY_FRAME_PROGRAM = re.compile(r"robot_state_publisher/|state_publisher/|apriltag\w*/|aruco\w*/|mocap\w*/|vrpn\w*/")
"""Programs that publish the transforms of any frame."""
_LOCALIZATION_PROGRAM = re.compile(
    r"fake_localization/|(nav2_)?amcl/|slam_\w+/|gmapping/|hector_mapping/|cartographer_ros/|rtabmap_\w+/|"
    r"robot_localization/(ekf|ukf)|robot_pose_ekf/|\w*odometry\w*/"
)
"""Programs that publish the transform between the map, the odometry and the robot."""
_LOCALIZATION_FRAME = re.compile(r"(.*/)?(map|odom|odom_combined|base|base_link|base_footprint|footprint)")
_PARAMETER_FILE = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w.-]+)\)/(?P<path>[^$\s,\]]+\.ya?ml)")
_FRAME_WORD = re.compile(r"[\w/.-]+")
_PARENT_FRAME = re.compile(r"--frame-id[ ,]+([^ ,\]]+)")


def find_other_publisher(transform: Entry, old: LaunchOutline, new: LaunchOutline, version: Version) -> Entry | None:
    """Return an added node that may publish the transform of a removed publisher, or None.

    A node may publish it if its program publishes static transforms, or if its parameters name both frames.

    Args:
        transform: the removed static transform publisher.
        old: the outline of the old file.
        new: the outline of the new file.
        version: the new version, with the parameter files.
    """
    frames = {frame.strip("/") for frame in _find_parent_and_child(transform, old)}
    if len(frames) != 2 or not transform.name.startswith(TRANSFORM_PUBLISHERS):
        return None
    old_programs = {entry.name for entry in old.entries if entry.kind == "node"}
    for entry in new.entries:
        if entry.kind != "node" or entry.name in old_programs or entry.name.startswith(TRANSFORM_PUBLISHERS):
            continue
        if evaluate_condition(new.resolve(entry.settings.get(CONDITION, ""))) is False:
            continue
        is_localized = _LOCALIZATION_PROGRAM.match(entry.name) and all(map(_LOCALIZATION_FRAME.fullmatch, frames))
        if (
            _ANY_FRAME_PROGRAM.match(entry.name)
            or is_localized
            or frames <= set(_find_parameter_words(entry, new, version))
        ):
            return entry
    return None


def _find_parent_and_child(transform: Entry, outline: LaunchOutline) -> list[str]:
    """Return the parent and child frames of a static transform; empty if unknown."""
    text = outline.resolve(transform.settings.get("arguments", ""))
    names = find_served_names(Entry(transform.kind, transform.name, {"arguments": text}, transform.span))
    if not names:
        return []
    parent = _PARENT_FRAME.search(text)
    if parent is not None:
        return [parent[1], names[0]]
    words = list_items(text) if text.startswith("[") else text.split()
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
