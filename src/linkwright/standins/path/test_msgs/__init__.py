"""Stands in for ``test_msgs``, whose interfaces come as those of every package."""

__all__: list[str] = []
