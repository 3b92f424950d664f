"""Vehicles of ArduPilot: ``libArduPilotPlugin.so`` and the older ``libArduCopterPlugin.so``.

ArduPilot's simulator in the loop (SITL) sends the pulse widths of its servos, and gets the motion of the vehicle after
each step (`packets`). The simulation does not wait for it: each state contains ``no_lockstep``.

Source: ardupilot_gazebo and Gazebo Classic (parameters, defaults, formulas).
"""

from __future__ import annotations

import socket
from contextlib import suppress
from dataclasses import dataclass
from math import pi
from time import monotonic

from linkwright.diagnostics import phrase
from linkwright.geometry.single import Pose, Transform, compose, invert, rotate
from linkwright.sdf.frames import transform_of
from linkwright.sdf.poses import POSE, SEPARATOR
from linkwright.sdf.reader import read_element
from linkwright.sdf.report import SdfReport
from linkwright.simulation.plugins.autopilots.channels import Channel, read_channel
from linkwright.simulation.plugins.autopilots.packets import MAX_PACKET_SIZE, Servos, VehicleState, parse_servos
from linkwright.simulation.plugins.contexts import model_plugins
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import PlacedSensor, SimulatedPlugin
from linkwright.simulation.sensors.imu import ImuSensor
from linkwright.simulation.sensors.mount import Mount

_HALF_TURN: Transform = transform_of(Pose(rpy=(pi, 0.0, 0.0)))
"""The default of both frames: x forward, y right and z down instead of x forward, y left and z up."""
_WAIT_S = 0.1
"""The real time in s that the autopilot has for each missed packet: ten times as long as Gazebo, which waits for it."""


@dataclass(frozen=True, kw_only=True)
class ArduPilotParameters:
    """Parameters of ``libArduPilotPlugin.so``."""

    fdm_addr: str = "127.0.0.1"
    fdm_port_in: int = 9002
    fdm_port_out: int = 9003
    imu_name: str = parameter("imu_sensor", aliases=("imuName",))
    timeout_count: int = parameter(10, aliases=("connectionTimeoutMaxCount",))
    no_time_sync: bool = True
    have_32_channels: bool = False


class ArduPilot(SimulatedPlugin[ArduPilotParameters]):
    """The substitute for ``libArduPilotPlugin.so``.

    Attributes:
        address: the address and the port at which the plugin listens.
        is_online: whether an autopilot sends commands.
    """

    PARAMETERS = ArduPilotParameters
    IGNORED = (
        *("control", "rotor", "sensor", "anemometer", "listen_addr", "lock_step"),
        *("gazeboXYZToNED", "modelXYZToAirplaneXForwardZDown"),
    )

    def start(self) -> None:
        """Find the joints and the IMU, and listen for the autopilot.

        Raises:
            LinkwrightError: SIM134, there is no such joint; SIM160, a channel is not valid, there is no such IMU, or
                the address cannot be used.
        """
        self._has_socket = False
        self._channels = self.read_channels()
        self._to_aircraft = self._read_frame("modelXYZToAirplaneXForwardZDown")
        self._from_world = invert(self._read_frame("gazeboXYZToNED"))
        self._placed_imu = self._find_imu()
        self._socket = self._bind()
        self._has_socket = True
        self.address: tuple[str, int] = self._socket.getsockname()
        self.simulation.keep_awake(self._placed_imu.link)
        self.reset()
        self.every(0.0, self._exchange)

    def reset(self) -> None:
        """Stop the motors, and wait for an autopilot."""
        mount = Mount(self.simulation, self._placed_imu.link, self._placed_imu.pose)
        self._imu = ImuSensor(mount, self._placed_imu.sensor.imu, generator=self.random)
        self.is_online = False
        self._servos: Servos | None = None
        self._client: tuple[str, int] | None = None
        self._missed_count, self._last_packet_s = 0, 0.0
        for channel in self._channels:
            channel.stop()

    def read_channels(self) -> list[Channel]:
        """Return the channels of the plugin's element.

        Raises:
            LinkwrightError: SIM134, there is no such joint; SIM160, a channel is not valid.
        """
        element = self.context.element
        controls = () if element is None else (*element.elements("control"), *element.elements("rotor"))
        return [read_channel(self, control, index) for index, control in enumerate(controls)]

    def stop(self) -> None:
        """Close the socket."""
        if self._has_socket:
            self._socket.close()

    def _read_frame(self, tag: str) -> Transform:
        """Return the pose in an element, or a half turn about x if it is absent."""
        element = None if self.context.element is None else self.context.element.first(tag)
        return _HALF_TURN if element is None else transform_of(read_element(element, POSE, SdfReport()).pose)

    def _find_imu(self) -> PlacedSensor:
        """Return the IMU with the name of the parameters."""
        context, name = self.context, self.parameters.imu_name
        assert context.model is not None
        contexts = model_plugins(context.world, context.model, context.path)
        sensors = [item.sensor for item in contexts if item.sensor is not None and item.sensor.sensor.type == "imu"]
        for sensor in sensors:
            if f"{SEPARATOR}{sensor.name}".endswith(f"{SEPARATOR}{name}"):
                return sensor
        raise self.parameter_error(
            phrase("plugin '{plugin}': there is no sensor '{name}' of type imu", plugin=context.name, name=name)
        )

    def _bind(self) -> socket.socket:
        """Return a socket at the address of the parameters."""
        address = self.parameters.fdm_addr, self.parameters.fdm_port_in
        endpoint = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            endpoint.bind(address)
        except (OSError, OverflowError) as error:
            endpoint.close()
            message = phrase(
                "plugin '{plugin}' cannot listen for the autopilot at {address}: {reason}",
                plugin=self.context.name,
                address=f"{address[0]}:{address[1]}",
                reason=getattr(error, "strerror", None) or str(error),
            )
            raise self.parameter_error(message) from error
        endpoint.setblocking(False)
        return endpoint

    def _exchange(self) -> None:
        """Receive the newest servos, move the joints, and send the state of the vehicle."""
        self._receive()
        if not self.is_online:
            return
        for channel in self._channels:
            channel.move()
        if self._client is not None and self._servos is not None:
            with suppress(OSError):  # the autopilot may have ended
                self._socket.sendto(self._servos.encode_reply(self._measure()), self._client)

    def _receive(self) -> None:
        """Take the newest packet of the autopilot, or count a missed one."""
        servos, sender = None, None
        with suppress(OSError):  # no more packets, or the autopilot has ended
            while True:
                data, new_sender = self._socket.recvfrom(MAX_PACKET_SIZE)
                packet = parse_servos(data, has_32_channels=self.parameters.have_32_channels)
                servos, sender = (servos, sender) if packet is None else (packet, new_sender)
        if servos is not None and sender is not None:
            self._accept(servos, sender)
        elif self.is_online:
            self._missed_count += 1
            limit = self.parameters.timeout_count
            if self._missed_count > limit and monotonic() - self._last_packet_s > limit * _WAIT_S:
                self._disconnect()

    def _accept(self, servos: Servos, sender: tuple[str, int]) -> None:
        """Set the commands of the channels from the servos of a packet."""
        self._client = (self.parameters.fdm_addr, self.parameters.fdm_port_out) if servos.is_binary else sender
        self._servos, self._missed_count, self._last_packet_s = servos, 0, monotonic()
        if not self.is_online:
            self.is_online = True
            self.node.logger.info(
                phrase(
                    "the autopilot at {address} controls '{model}'",
                    address=f"{sender[0]}:{sender[1]}",
                    model=self.context.path,
                )
            )
        for channel in self._channels:
            channel.set_command(servos)

    def _disconnect(self) -> None:
        self.is_online = False
        self.node.logger.warning(
            phrase("the autopilot no longer sends commands to '{model}', so its motors stop", model=self.context.path)
        )
        for channel in self._channels:
            channel.stop()

    def _measure(self) -> VehicleState:
        """Return the motion of the link with the IMU in ArduPilot's axes."""
        simulation, link = self.simulation, self._placed_imu.link
        measurement = self._imu.measure()
        pose = compose(compose(self._from_world, simulation.link_pose(link)), self._to_aircraft)
        vx, vy, vz = simulation.link_velocity(link)[0].tolist()
        return VehicleState(
            simulation.seconds,
            measurement.angular_velocity,
            measurement.linear_acceleration,
            pose,
            rotate(self._from_world[3:], (vx, vy, vz)),
            no_time_sync=self.parameters.no_time_sync,
        )


_MAX_SPEED = 838.0
"""The default of the greatest speed of a rotor in rad/s."""


class ArduCopter(ArduPilot):
    """The substitute for ``libArduCopterPlugin.so``: a multicopter, whose rotors are the channels in their order."""

    def read_channels(self) -> list[Channel]:
        """Return the channels, one for each rotor."""
        element = self.context.element
        rotors = () if element is None else tuple(element.elements("rotor"))
        channels = [read_channel(self, rotor, index) for index, rotor in enumerate(rotors)]
        for index, (rotor, channel) in enumerate(zip(rotors, channels, strict=True)):
            channel.number = index
            channel.multiplier *= self.number_in(rotor, "maxRpm", _MAX_SPEED)
        return channels
