"""Packs: folders, for example on memory sticks, from which a class installs Linkwright offline."""
