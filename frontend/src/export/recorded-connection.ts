import { Connection } from "../connection/connection";
import type { FrameTable, JointControl, PageMessage, Property, RobotMeasured } from "../protocol";
import { unpackTransforms } from "../connection/transforms";
import { MovingRobot } from "./moving-robot";
import { decodeBase64, type Recording } from "./recording";

const GRID_CLASS = "rviz_default_plugins/Grid";
const TF_CLASS = "rviz_default_plugins/TF";
/** The length of TF's axes at Marker Scale 1. */
const AXIS_LENGTH_M = 0.2;

/** Replaces the server in an exported page: emits the recorded messages, and moves the robot's joints. */
export class RecordedConnection extends Connection {
  private controls: readonly JointControl[] = [];
  private robot: MovingRobot | null = null;
  private positions: Record<string, number> = {};
  private startPositions: Readonly<Record<string, number>> = {};

  constructor(private readonly recording: Recording) {
    super("");
  }

  override open(): void {
    const { messages, frames } = this.recording;
    this.setState("connected");
    for (const message of messages) {
      this.message.emit(message);
      if (message.type === "joints") this.controls = message.controls ?? [];
      if (message.type === "joint_positions") this.positions = { ...message.positions };
      if (message.type === "frame_table") this.createRobot(message);
    }
    this.startPositions = { ...this.positions };
    for (const frame of frames) this.receiveBytes(decodeBase64(frame).buffer);
    this.emitPositions();
  }

  /** Handles requests that move joints. Other requests need a server; the page shows its own edits without one. */
  override send(message: PageMessage): void {
    const { controls } = this;
    if (message.type === "set_joint") this.move({ [message.name]: message.position });
    else if (message.type === "set_joints") this.move(message.positions);
    else if (message.type === "center_joints") this.move(Object.fromEntries(controls.map(({ name, zero }) => [name, zero])));
    else if (message.type === "randomize_joints") this.move(Object.fromEntries(controls.map((control) => [control.name, drawRandomPosition(control)])));
    else if (message.type === "robot_measured") this.fitSizes(message);
  }

  /** Moves the joints to their positions at the time of the export. */
  reset(): void {
    this.positions = { ...this.startPositions };
    this.emitPositions();
  }

  /**
   * Places the grid on the ground below the robot, and fits its cells and TF's axes to the robot's size, as the server
   * of `view` does by default.
   */
  private fitSizes({ diagonal, ground }: RobotMeasured): void {
    const { messages, awaits_size, spacing } = this.recording;
    const displays = messages.find((message) => message.type === "tree")?.displays ?? [];
    const findProperty = (drawing: string, name: string): Property | undefined =>
      displays.find((display) => display.drawing === drawing)?.properties.find((property) => property.name === name);
    const setValue = ({ id }: Property, value: number): void => this.message.emit({ type: "property_changed", id, value, options: null });
    const height = findProperty(GRID_CLASS, "Offset")?.children.find(({ name }) => name === "Z");
    if (height?.value === 0 && ground !== 0) setValue(height, ground);
    if (!awaits_size || diagonal <= 0) return;
    const [cellSize, markerScale] = [findProperty(GRID_CLASS, "Cell Size"), findProperty(TF_CLASS, "Marker Scale")];
    if (cellSize) setValue(cellSize, chooseCellSize(diagonal));
    if (markerScale) setValue(markerScale, chooseMarkerScale(diagonal, spacing ?? diagonal));
  }

  private createRobot(table: FrameTable): void {
    const { messages, frames, display } = this.recording;
    const robot = messages.find((message) => message.type === "robot_scene" && message.display === display);
    const transforms = frames.map((frame) => unpackTransforms(decodeBase64(frame).buffer)).find((unpacked) => unpacked !== null);
    if (robot?.type !== "robot_scene" || !transforms) return;
    const comparison = messages.find((message) => message.type === "compared_descriptions");
    const oldRobot = comparison && messages.find((message) => message.type === "robot_scene" && message.display === comparison.old.display);
    const followingRobots = oldRobot?.type === "robot_scene" && oldRobot !== robot ? [{ robot: oldRobot, joints: comparison?.joints ?? {} }] : [];
    this.robot = new MovingRobot(table, transforms, robot, this.controls, followingRobots);
  }

  private move(positions: Readonly<Record<string, number>>): void {
    for (const { name, mimic, lower, upper } of this.controls) {
      const position = positions[name];
      if (position !== undefined && mimic === null) this.positions[name] = Math.min(upper, Math.max(lower, position));
    }
    this.emitPositions();
  }

  private emitPositions(): void {
    const { robot, positions } = this;
    if (!robot) return;
    for (const { name, mimic } of this.controls) if (mimic !== null) positions[name] = robot.computePosition(name, positions);
    this.transforms.emit(robot.computeTransforms(positions));
    this.message.emit({ type: "joint_positions", positions: { ...positions } });
  }
}

/**
 * Returns the side of a grid cell for a robot with a bounding box of this diagonal, m: `ModelSize.cell` of
 * `rviz/config/views.py`.
 */
function chooseCellSize(diagonal: number): number {
  return 10 ** Math.floor(Math.log10(diagonal * 1.5));
}

/** Returns TF's Marker Scale with which axes and links can be distinguished: `ModelSize.marker_scale` of the server. */
function chooseMarkerScale(diagonal: number, spacing: number): number {
  const axisLength = Math.min(Math.max(spacing / 2, diagonal / 40), diagonal / 10);
  return Number((axisLength / AXIS_LENGTH_M).toPrecision(2));
}

function drawRandomPosition({ lower, upper }: JointControl): number {
  return lower + Math.random() * (upper - lower);
}
