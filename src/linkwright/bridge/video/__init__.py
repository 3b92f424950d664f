"""The endpoint for browsers that show images: ``web_video_server``."""

from linkwright.bridge.video.node import WebVideoServer

__all__ = ["WebVideoServer"]
