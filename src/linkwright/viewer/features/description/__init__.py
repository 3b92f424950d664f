"""What pages show of the description behind a robot."""

from linkwright.viewer.features.description.feature import DescriptionFeature

__all__ = ["DescriptionFeature"]
