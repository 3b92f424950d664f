"""Stands in for ``nav2_common``, what launch files of Navigation2 share."""

__all__: list[str] = []
