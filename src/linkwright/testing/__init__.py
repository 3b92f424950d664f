"""Testing nodes: graphs whose time stands still until the test lets it pass, so that an hour takes milliseconds."""

from linkwright.testing.recording import Recording
from linkwright.testing.stepped import AsyncSteppedGraph
from linkwright.testing.stepped_sync import SteppedGraph

__all__ = ["AsyncSteppedGraph", "Recording", "SteppedGraph"]
