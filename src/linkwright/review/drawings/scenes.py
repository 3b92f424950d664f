"""Build 3D scenes of both versions of a robot, for a page that draws them without a server."""

from __future__ import annotations

import gzip
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.descriptions import Description, DescriptionLibrary
from linkwright.descriptions.pairs import Pair, make_old_description_key
from linkwright.diagnostics import LinkwrightError, display_path, phrase
from linkwright.review.changes import RobotScene

if TYPE_CHECKING:
    from linkwright.panels.export.snapshot import Snapshot

_MAX_BYTES = 15_000_000
"""The maximum size of a compressed scene. Meshes are most of it."""


def build_robot_scene(models: Pair, old: Description, new: Description, roots: Sequence[Path]) -> RobotScene:
    """Return a scene of both robots placed over each other, or the reason why there is none.

    A scene contains the meshes. A description can name any file of the computer as a mesh, so a description
    that names files outside the repository and outside packages gets no scene.

    Args:
        models: both models.
        old: the description in the old version.
        new: the description in the new version.
        roots: the folders of both versions of the repository.
    """
    from linkwright.panels.export.html import recording_to_json, split_page

    try:
        split_page("")  # the page is not built in every installation
        snapshot = _take_snapshot(models, old, new)
    except LinkwrightError as error:
        return RobotScene(reason=phrase("the scene in 3D is left out: {reason}", reason=error.diagnostics[0].message))
    outside = [path for path in snapshot.outside_files if not any(path.is_relative_to(root) for root in roots)]
    if outside:
        reason = phrase(
            "the scene in 3D is left out: it would contain files outside the repository, such as '{path}'",
            path=display_path(outside[0]),
        )
        return RobotScene(reason=reason)
    data = gzip.compress(recording_to_json(snapshot).encode(), mtime=0)
    if len(data) > _MAX_BYTES:
        text = phrase("the scene in 3D is left out: it has {size:.0f} MB", size=len(data) / 1e6)
        return RobotScene(reason=text)
    return RobotScene(data)


def _take_snapshot(models: Pair, old: Description, new: Description) -> Snapshot:
    from linkwright.viewer.model_snapshot import OldDescription, take_model_snapshot

    library = DescriptionLibrary()
    assert new.robot is not None, "robots are compared"
    old_text = library.store(old, make_old_description_key(old), models.old.finder)
    compared = OldDescription(models, old_text)
    return take_model_snapshot(library.store(new), new.robot, library, models.new.finder, compared)
