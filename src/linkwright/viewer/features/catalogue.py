"""The features of a viewer, found through the entry points ``linkwright.page_features``."""

from __future__ import annotations

from linkwright.extensions import extensions
from linkwright.viewer.features.page_feature import FeatureHost, PageFeature

GROUP = "linkwright.page_features"
"""Of the entry points."""


def make_features(viewer: FeatureHost) -> list[PageFeature]:
    """A feature of each kind; one of another package that cannot be made is told of in the log, and left out."""
    made: list[PageFeature] = []
    for name, entry in extensions(GROUP).items():
        try:
            feature = entry.load()(viewer)
        except Exception as error:  # noqa: BLE001  # of a package that is not ours anything may be wrong
            problem = f"{type(error).__name__}: {error}"
        else:
            if isinstance(feature, PageFeature):
                made.append(feature)
                continue
            problem = f"{entry.value} makes no PageFeature"
        viewer.context.node.get_logger().error(f"The page feature '{name}' cannot be had: {problem}")
    return made
