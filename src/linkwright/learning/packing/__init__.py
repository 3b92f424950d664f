"""Packs: folders from which a class installs Linkwright offline, as from memory sticks."""
