"""Services that control a player, such as ``/rosbag2_player/pause``, as in rosbag2."""

from __future__ import annotations

from typing import Any

from linkwright.bag.player import Player
from linkwright.graph import Node

_SERVICES = (
    ("pause", "Pause"),
    ("resume", "Resume"),
    ("toggle_paused", "TogglePaused"),
    ("is_paused", "IsPaused"),
    ("get_rate", "GetRate"),
    ("set_rate", "SetRate"),
    ("play", "Play"),
    ("play_next", "PlayNext"),
    ("burst", "Burst"),
    ("seek", "Seek"),
    ("stop", "Stop"),
)


class PlayerServices:
    """The services that control a player, below the name of a node.

    Names, types and responses to errors follow ``rosbag2_transport::Player``.

    Args:
        node: the node.
        player: the player that the services control.
    """

    def __init__(self, node: Node, player: Player) -> None:
        self._player = player
        self._logger = node.get_logger()
        for name, type_name in _SERVICES:
            node.create_service(f"rosbag2_interfaces/srv/{type_name}", f"~/{name}", getattr(self, f"_{name}"))

    def _pause(self, _: Any, response: Any) -> Any:
        self._player.pause()
        return response

    def _resume(self, _: Any, response: Any) -> Any:
        self._player.resume()
        return response

    def _toggle_paused(self, _: Any, response: Any) -> Any:
        self._player.toggle_paused()
        return response

    def _is_paused(self, _: Any, response: Any) -> Any:
        response.paused = self._player.paused
        return response

    def _get_rate(self, _: Any, response: Any) -> Any:
        response.rate = self._player.rate
        return response

    def _set_rate(self, request: Any, response: Any) -> Any:
        try:
            self._player.set_rate(request.rate)
        except ValueError as error:
            self._logger.warning(f"Failed to set the rate: {error}")
        else:
            response.success = True
        return response

    def _play(self, _: Any, response: Any) -> Any:
        """Reject the request, because the recording is already playing.

        rosbag2 also rejects the request during playback, and its program ends when playback ends.
        """
        self._logger.warning("The recording is already playing: the request is ignored")
        response.success = False
        return response

    def _play_next(self, _: Any, response: Any) -> Any:
        response.success = self._require_paused("play the next message") and self._player.play_next()
        return response

    def _burst(self, request: Any, response: Any) -> Any:
        if self._require_paused("play a burst"):
            response.actually_burst = self._player.burst(request.num_messages)
        return response

    def _seek(self, request: Any, response: Any) -> Any:
        self._player.seek(request.time.nanoseconds)
        response.success = True
        return response

    def _stop(self, _: Any, response: Any) -> Any:
        self._player.close()
        return response

    def _require_paused(self, action: str) -> bool:
        if not self._player.paused:
            self._logger.warning(f"Cannot {action} while the recording is playing: pause it first")
        return self._player.paused
