"""What pages are told of the description behind a robot."""

from linkwright.viewer.description.feature import DescriptionFeature

__all__ = ["DescriptionFeature"]
