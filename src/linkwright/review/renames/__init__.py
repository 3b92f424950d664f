"""Recognize folders, packages, sensors and plugins that only have another name, so that each is one change."""
