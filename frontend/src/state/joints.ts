import type { Connection } from "../connection/connection";
import type { JointControl } from "../protocol";
import { Signal } from "../signal";
import type { PageMemory } from "./page-memory";

/** The maximum number of joints in one message, because the server accepts messages of 64 KiB. */
const MAX_JOINTS_PER_MESSAGE = 200;

export type Positions = Readonly<Record<string, number>>;

/** The joints of the Joints panel, and the last positions from the server. */
export class JointsState {
  readonly controlsChanged = new Signal();
  readonly positionsChanged = new Signal();
  /** The controllable joints; null while no sliders publish positions. */
  controls: readonly JointControl[] | null = null;
  positions: Positions = {};
  /** Whether links can be dragged without Alt. */
  dragsWithoutAlt = false;
  private pendingPositions: Record<string, number> | null = null;
  /** The latest joints, also after the program has ended. */
  private latestControls: readonly JointControl[] = [];
  /** The joint positions from before a restart of the program, until the new program has sliders. */
  private positionsBeforeRestart: Positions = {};

  constructor(
    private readonly connection: Connection,
    private readonly requestFrame: (action: () => void) => void = (action) => void requestAnimationFrame(action),
  ) {
    connection.on("joints", ({ controls }) => this.setControls(controls));
    connection.on("joint_positions", ({ positions }) => this.setPositions(positions));
  }

  /** Preserves across reloads of the page whether links can be dragged without Alt. */
  preserveIn(memory: PageMemory): void {
    memory.preserve("hands on", () => this.dragsWithoutAlt, (isOn) => (this.dragsWithoutAlt = isOn));
  }

  /**
   * Moves joints, rad or m. The first move is sent immediately; further moves until the next animation frame are sent
   * together.
   */
  move(positions: Positions): void {
    if (this.pendingPositions) {
      Object.assign(this.pendingPositions, positions);
      return;
    }
    this.send(positions);
    this.pendingPositions = {};
    this.requestFrame(() => {
      const positions = this.pendingPositions ?? {};
      this.pendingPositions = null;
      if (Object.keys(positions).length > 0) this.move(positions);
    });
  }

  /** Returns the joint that must be moved so that `name` gets to `position`, and its position; null if no joint can. */
  findLeader(name: string, position: number): { control: JointControl; position: number } | null {
    const visited = new Set<string>();
    for (let leaderPosition = position, jointName = name; !visited.has(jointName); ) {
      visited.add(jointName);
      const control = this.controls?.find((candidate) => candidate.name === jointName);
      if (!control) return null;
      if (control.mimic === null) return { control, position: leaderPosition };
      if (control.multiplier === 0) return null;
      leaderPosition = (leaderPosition - control.offset) / control.multiplier;
      jointName = control.mimic;
    }
    return null;
  }

  /** Moves joints back to their positions after the program was restarted, if it shows the same robot. */
  onProgramRestarted(isSameRobot: boolean): void {
    const movedJoints = this.latestControls.filter(({ name, mimic, zero }) => mimic === null && this.positions[name] !== zero);
    const positions = movedJoints.map(({ name }) => [name, this.positions[name]]).filter(([, position]) => position !== undefined);
    this.positionsBeforeRestart = isSameRobot ? { ...this.positionsBeforeRestart, ...(Object.fromEntries(positions) as Positions) } : {};
  }

  private setControls(controls: readonly JointControl[] | null): void {
    this.controls = controls;
    this.controlsChanged.emit();
    if (controls === null || controls.length === 0) return;
    this.latestControls = controls;
    const names = new Set(controls.map(({ name }) => name));
    const positions = Object.entries(this.positionsBeforeRestart).filter(([name]) => names.has(name));
    this.positionsBeforeRestart = {};
    this.send(Object.fromEntries(positions));
  }

  private setPositions(positions: Positions): void {
    this.positions = positions;
    this.positionsChanged.emit();
  }

  private send(positions: Positions): void {
    const entries = Object.entries(positions);
    const [entry] = entries;
    if (entry && entries.length === 1) {
      this.connection.send({ type: "set_joint", name: entry[0], position: entry[1] });
      return;
    }
    for (let i = 0; i < entries.length; i += MAX_JOINTS_PER_MESSAGE) {
      const batch = Object.fromEntries(entries.slice(i, i + MAX_JOINTS_PER_MESSAGE));
      this.connection.send({ type: "set_joints", positions: batch });
    }
  }
}
