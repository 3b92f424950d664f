"""Vehicles of PX4: ``libgazebo_mavlink_interface.so`` and its older name ``librotors_gazebo_mavlink_interface.so``.

PX4's simulator in the loop (SITL) gets the measurements of the model's sensor plugins 250 times per simulated second,
and sends the commands of its channels. With ``<enable_lockstep>``, the simulation waits up to 10 ms for the commands of
an armed vehicle.

Source: PX4-SITL_gazebo-classic (parameters, defaults, rates, formulas). Unlike there, TCP is open to other computers
only if ``<mavlink_addr>`` is an address. Distances, optical flow and visual odometry are not sent.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, degrees, hypot, sqrt
from time import monotonic
from typing import Any, TypeVar

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform, Vector3, compose, invert, rotate
from linkwright.simulation.plugins.autopilots.connections import TcpConnection, UdpConnection
from linkwright.simulation.plugins.autopilots.mavlink import (
    AirSample,
    Controls,
    GpsSample,
    MavlinkReader,
    MavlinkWriter,
    SensorSample,
    StateSample,
)
from linkwright.simulation.plugins.autopilots.px4_channels import Px4Channel, read_channels
from linkwright.simulation.plugins.multicopter import GzMulticopterMotor
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.px4.air import Px4Airspeed
from linkwright.simulation.plugins.px4.sensors import (
    ModelSensor,
    Px4Barometer,
    Px4Gps,
    Px4Groundtruth,
    Px4Imu,
    Px4Magnetometer,
)

S = TypeVar("S", bound=ModelSensor[Any])

_RATE_HZ = 250.0
_LOCKSTEP_WAIT_S = 0.01
_SILENCE_S = 2.0
"""The real time in s without commands after which the motors stop."""
_ANY_ADDRESS, _LOCAL_ADDRESS = "INADDR_ANY", "127.0.0.1"
_TOLERANCE_S = 1e-6
_NORTH_EAST_DOWN: Transform = (0.0, 0.0, 0.0, sqrt(0.5), sqrt(0.5), 0.0, 0.0)
"""The rotation of the world's axes east, north, up, as a pose."""
_FORWARD_RIGHT_DOWN: Transform = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
_FREEZING_POINT_K, _SEA_TEMPERATURE_K, _LAPSE_RATE = 273.15, 288.15, 0.0065


@dataclass(frozen=True, kw_only=True)
class MavlinkParameters:
    """Parameters of ``libgazebo_mavlink_interface.so``."""

    mavlink_addr: str = _ANY_ADDRESS
    mavlink_tcp_port: int = 4560
    mavlink_udp_port: int = 14560
    use_tcp: bool = False
    enable_lockstep: bool = False
    hil_mode: bool = False
    serial_enabled: bool = parameter(False, aliases=("serialEnabled",))
    motor_topic: str = parameter("/gazebo/command/motor_speed", aliases=("motorSpeedCommandPubTopic",))


class Px4Interface(SimulatedPlugin[MavlinkParameters]):
    """The substitute for ``libgazebo_mavlink_interface.so``.

    Attributes:
        connection: the connection to the autopilot.
        is_online: whether an autopilot sends commands.
    """

    PARAMETERS = MavlinkParameters
    IGNORED = (
        *("control_channels", "serialDevice", "baudRate", "imu_rate", "hil_state_level"),
        *("qgc_addr", "qgc_udp_port", "sdk_addr", "sdk_udp_port", "send_vision_estimation", "send_odometry"),
        *("imuSubTopic", "magSubTopic", "baroSubTopic", "gpsSubTopic", "airspeedSubTopic", "groundtruthSubTopic"),
        *("lidarSubTopic", "sonarSubTopic", "opticalFlowSubTopic", "irlockSubTopic", "visionSubTopic"),
        *("targetGpsSubTopic", "arucoMarkerSubTopic", "vehicle_is_tailsitter", "protocol_version"),
    )

    def start(self) -> None:
        """Find the joints, and open the connection.

        Raises:
            LinkwrightError: SIM160, a channel is not valid, the address cannot be used, or hardware is asked for.
        """
        self._has_connection = False
        if self.parameters.hil_mode or self.parameters.serial_enabled:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': hardware in the loop is not simulated; set <hil_mode> and <serialEnabled> to 0",
                    plugin=self.context.name,
                )
            )
        self._channels: tuple[Px4Channel, ...] = read_channels(self)
        self.connection = self._connect()
        self._has_connection = True
        self.reset()
        self.every(_RATE_HZ, self._exchange)

    def reset(self) -> None:
        """Stop the motors, and wait for commands."""
        self._reader, self._writer = MavlinkReader(), MavlinkWriter()
        self.is_online = self._is_armed = False
        self._last_commands_s = 0.0
        self._due_times: dict[str, float] = {}
        self._stop_motors()

    def stop(self) -> None:
        """Close the connection."""
        if self._has_connection:
            self.connection.close()

    def _connect(self) -> TcpConnection | UdpConnection:
        """Return the connection that the parameters describe.

        Raises:
            LinkwrightError: SIM160, the address cannot be used.
        """
        parameters = self.parameters
        host = _LOCAL_ADDRESS if parameters.mavlink_addr == _ANY_ADDRESS else parameters.mavlink_addr
        port = parameters.mavlink_tcp_port if parameters.use_tcp else parameters.mavlink_udp_port
        try:
            return TcpConnection((host, port)) if parameters.use_tcp else UdpConnection((host, port))
        except (OSError, OverflowError) as error:
            message = phrase(
                "plugin '{plugin}' cannot listen for the autopilot at {address}: {reason}",
                plugin=self.context.name,
                address=f"{host}:{port}",
                reason=getattr(error, "strerror", None) or str(error),
            )
            raise self.parameter_error(message) from error

    def _exchange(self) -> None:
        """Take the newest commands, send the measurements, and move the joints and rotors."""
        self._receive()
        if self.connection.peer is not None:
            self._send()
        if not self.is_online:
            return
        for channel in self._channels:
            channel.move()
        for motor in self._find_motors():
            number = motor.parameters.actuator_number
            motor.target_speed = next((item.command for item in self._channels if item.number == number), 0.0)

    # --- commands -----------------------------------------------------------------------------------------------------

    def _receive(self) -> None:
        """Take the newest commands, or stop the motors if there have been none for a time."""
        waits = self.is_online and self._is_armed and self.parameters.enable_lockstep
        commands = self._reader.read(self.connection.receive(_LOCKSTEP_WAIT_S if waits else 0.0))
        if commands:
            self._accept(commands[-1])
        elif self.is_online and (self.connection.peer is None or monotonic() - self._last_commands_s > _SILENCE_S):
            self.is_online = self._is_armed = False
            self._stop_motors()
            model = self.context.path
            self.node.logger.warning(
                phrase("the autopilot no longer sends commands to '{model}', so its motors stop", model=model)
            )

    def _accept(self, controls: Controls) -> None:
        self._last_commands_s, self._is_armed = monotonic(), controls.is_armed
        if not self.is_online and self.connection.peer is not None:
            self.is_online = True
            host, port = self.connection.peer
            self.node.logger.info(
                phrase(
                    "the autopilot at {address} controls '{model}'", address=f"{host}:{port}", model=self.context.path
                )
            )
        for channel in self._channels:
            channel.set_command(controls)

    def _stop_motors(self) -> None:
        for channel in self._channels:
            channel.stop()
        for motor in self._find_motors():
            motor.target_speed = 0.0

    def _find_motors(self) -> list[GzMulticopterMotor]:
        """Return the running rotors of the model that listen to the topic of the parameters."""
        topic = self.parameters.motor_topic.strip("/")
        motors = (plugin for plugin in self.model_plugins if isinstance(plugin, GzMulticopterMotor))
        return [motor for motor in motors if motor.parameters.command_topic.strip("/") == topic]

    # --- measurements -------------------------------------------------------------------------------------------------

    def _send(self) -> None:
        """Send the measurements that are due."""
        microseconds, packets = self.simulation.time // 1000, b""
        imu = self._find_sensor(Px4Imu)
        if imu is not None:
            packets += self._writer.encode_sensor(microseconds, self._measure(imu))
        truth = self._find_sensor(Px4Groundtruth)
        if truth is not None:
            packets += self._writer.encode_state(microseconds, self._measure_state(truth))
        gps = self._find_due_sensor(Px4Gps)
        fix = None if gps is None else gps.receive()
        if fix is not None:
            packets += self._writer.encode_gps(microseconds, _to_gps_sample(*fix))
        if packets:
            self.connection.send(packets)

    def _measure(self, imu: Px4Imu) -> SensorSample:
        """Return the measurements of the IMU, and of other sensors if they are due."""
        _, rates, acceleration = imu.measure_motion()
        magnetometer, barometer = self._find_due_sensor(Px4Magnetometer), self._find_due_sensor(Px4Barometer)
        air_speed = self._find_due_sensor(Px4Airspeed)
        air = None
        if barometer is not None:
            pressure, altitude = barometer.measure_air()
            air = AirSample(pressure, altitude, _SEA_TEMPERATURE_K - _LAPSE_RATE * altitude - _FREEZING_POINT_K)
        return SensorSample(
            _to_aircraft(acceleration),
            _to_aircraft(rates),
            None if magnetometer is None else _to_aircraft(magnetometer.measure_field()),
            air,
            None if air_speed is None else air_speed.measure_pressure(),
        )

    def _measure_state(self, truth: Px4Groundtruth) -> StateSample:
        """Return the true motion of the model."""
        pose, (linear, angular) = truth.mount.pose(), truth.mount.velocity()
        aircraft = compose(compose(_NORTH_EAST_DOWN, pose), _FORWARD_RIGHT_DOWN)
        to_body = invert(pose)[3:]
        x, y, z, w = aircraft[3:]
        velocity, rates = _to_vector(linear), _to_vector(angular)
        return StateSample(
            (w, x, y, z),
            _to_aircraft(rotate(to_body, rates)),
            truth.locate(),
            _to_vector(rotate(_NORTH_EAST_DOWN[3:], velocity)),
            rotate(to_body, velocity)[0],
        )

    def _find_sensor(self, kind: type[S]) -> S | None:
        """Return the first running sensor plugin of a kind in the model."""
        return next((plugin for plugin in self.model_plugins if isinstance(plugin, kind)), None)

    def _find_due_sensor(self, kind: type[S]) -> S | None:
        """Return the sensor plugin of a kind if its rate asks for a measurement now."""
        sensor = self._find_sensor(kind)
        now = self.simulation.seconds
        if sensor is None or now < self._due_times.get(kind.__name__, 0.0):
            return None
        self._due_times[kind.__name__] = now + sensor.period - _TOLERANCE_S
        return sensor


def _to_vector(values: Array | Vector3) -> Vector3:
    x, y, z = (float(value) for value in values)
    return x, y, z


def _to_aircraft(values: Array | Vector3) -> Vector3:
    """Return a vector with the axes forward, left, up in the axes forward, right, down."""
    x, y, z = (float(value) for value in values)
    return x, -y, -z


def _to_gps_sample(position: Vector3, velocity: Array) -> GpsSample:
    """Return a measurement with its course, from a velocity towards east, north and up."""
    east, north, up = _to_vector(velocity)
    return GpsSample(position, (north, east, -up), hypot(east, north), degrees(atan2(east, north)) % 360.0)
