"""Find the models that launch files newly spawn in a world."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import PurePosixPath

from linkwright.review.files.worlds.spawned_models import SpawnedModel
from linkwright.review.launch_paths import find_launch_files, is_launch_file
from linkwright.review.launches.outlines import CONDITION
from linkwright.review.launches.programs.sources import list_nodes, try_read_outline
from linkwright.review.versions import Version, Versions

_NAME_OPTIONS: Mapping[str, str] = {
    "gazebo_ros/spawn_model": "-model",
    "gazebo_ros/spawn_entity.py": "-entity",
    "ros_gz_sim/create": "-name",
    "ros_ign_gazebo/create": "-name",
}
"""The options for the name of the model, by program."""
_POSE_OPTIONS = ("-x", "-y", "-z", "-R", "-P", "-Y")
_SEPARATORS = re.compile(r"[\s,\[\]]+")


def find_spawned_models(versions: Versions, path: str) -> dict[str, SpawnedModel]:
    """Return the models that launch files which start a world newly spawn, by name.

    A model does not count if a launch file starts the world without it.

    Args:
        versions: both versions.
        path: the path of the world in the new version.
    """
    name = re.compile(rf"(?<![\w-]){re.escape(PurePosixPath(path).name)}")
    users = [file for file in find_launch_files(versions.new) if name.search(versions.new.text(file))]
    spawned = [_read_spawned_models(versions.new, user) for user in users]
    if not spawned:
        return {}
    changed = [file for file in versions.changed_files if file.old_path and is_launch_file(file.old_path)]
    old_names = {model for file in changed for model in _read_spawned_models(versions.old, file.old_path or "")}
    return {
        model: value
        for model, value in spawned[0].items()
        if model not in old_names and all(model in others for others in spawned)
    }


def _read_spawned_models(version: Version, path: str) -> dict[str, SpawnedModel]:
    """Return the models that a launch file spawns, by name."""
    outline = try_read_outline(version, path)
    found: dict[str, SpawnedModel] = {}
    for entry in () if outline is None else list_nodes(outline):
        option = _NAME_OPTIONS.get(entry.name)
        words = _SEPARATORS.split(entry.settings.get("arguments", ""))
        if option in words[:-1]:
            name = words[words.index(option or "") + 1]
            found[name] = SpawnedModel(path, entry.settings.get(CONDITION, ""), _read_pose(words))
    return found


def _read_pose(words: Sequence[str]) -> tuple[float, ...] | None:
    values = dict(pairwise(words))
    try:
        return tuple(float(values.get(option, "0")) for option in _POSE_OPTIONS)
    except ValueError:
        return None
